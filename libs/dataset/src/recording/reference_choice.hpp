#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"

#include "recording/statements.hpp"

namespace traverse::dataset {

/// A trajectory file and what must be known to use it.
struct ReferenceFile {
  std::filesystem::path file;
  TrajectoryFormat format = TrajectoryFormat::kAuto;
  ReferenceFrame frame = ReferenceFrame::kBody;
  std::string reason;  ///< why this file: "traverse.yaml, line 4"
  std::string frame_reason;
  std::optional<double> north_deg = {};  ///< true north in the file's map, from x towards y
};

/// Where the sensors are whose poses a reference may hold.
struct ReferenceFrames {
  geometry::Pose3 T_body_lidar;
  std::optional<geometry::Pose3> T_body_camera;
};

/// The stamps that poses without any take by their number; a pose whose number has none is left
/// out.
using PoseStamps = std::vector<std::optional<geometry::Stamp>>;

/// The file that the statements name, if they do. \throws files::InputError if it is not there.
std::optional<ReferenceFile> stated_reference(const Statements& statements);

/// Reads the file and brings its poses to the body frame: with X = T_body_sensor, T_map_body is
/// X T_map_sensor X^-1, so that a first pose at the origin stays there.
/// \throws files::InputError if the file cannot be used: poses without stamps that are not as many
/// as the stamps, a camera whose pose is not known.
Reference load_reference(const ReferenceFile& file, const ReferenceFrames& frames,
                         const PoseStamps& stamps, std::vector<Fact>& facts);

}  // namespace traverse::dataset
