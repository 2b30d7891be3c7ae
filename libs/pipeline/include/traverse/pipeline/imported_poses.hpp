#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/dataset/source.hpp"
#include "traverse/geometry/trajectory.hpp"
#include "traverse/pipeline/preset.hpp"

namespace traverse::pipeline {

/// What is stated of poses that another program made: the settings `poses.*` of such a run.
struct ImportOptions {
  std::string file;             ///< trajectory file, bag or folder of a bag; empty: no poses
  std::string format = "auto";  ///< a name of dataset::kTrajectoryFormatNames
  std::string columns;          ///< of CSV files, as dataset::TrajectoryChoice has it
  std::string topic;            ///< of bags, likewise
  std::string frame = "lidar";  ///< what moves along them: body, lidar, camera
  /// x y z [m] and qx qy qz qw, or the twelve numbers of a 3x4 matrix, row after row: the pose of
  /// the frame that moves along them in `frame`. Empty: they are one.
  std::vector<double> extrinsic;
  double time_offset_s = 0;  ///< added to their stamps
  std::string time_offset_reason = "as stated";
  double max_gap_s = 0.5;  ///< poses further apart are not interpolated between
  bool deskew = true;
  std::int64_t first_scan = 0;  ///< number of the first scan that is read
  std::string timing;           ///< YAML file, see ForeignTiming; empty: nothing is known
};
void bind(config::Binder& binder, ImportOptions& options);

/// Poses that another program made, brought to the frames of a recording.
struct ImportedPoses {
  /// With stamps, or one for each of `scans`. As with references T_map_body = X T X^-1, where X is
  /// the pose in the body of what moves along them; T X^-1 where the vehicle stands more upright.
  geometry::Trajectory T_map_body;
  std::vector<std::size_t> scans;  ///< numbers of scans; empty where there are stamps
  std::string read_as;             ///< "TUM, 8 columns between blanks"
  std::vector<std::string> notes;  ///< as dataset::TrajectoryReading has them
};

/// \throws files::InputError for a file that cannot be read, an extrinsic that is none, a frame
/// that the recording does not know
ImportedPoses read_imported_poses(const ImportOptions& options,
                                  const dataset::RecordingInfo& recording);

/// What the other program's run cost, as its user tells: a YAML file with any of the keys threads,
/// wall_s, peak_memory_mb and frame_ms, a list with one number for each pose.
struct ForeignTiming {
  std::optional<int> threads;
  std::optional<double> wall_s;
  std::optional<double> peak_memory_mb;
  std::vector<double> frame_ms;  ///< empty: not known
};
/// \param poses how many there are \throws files::InputError
ForeignTiming read_foreign_timing(const std::string& file, std::size_t poses);

/// A preset by which make_pipeline() makes a run of given poses. \param name of the program that
/// made them \param assignments as "poses.file=estimate.tum"
/// \throws files::InputError for a wrong assignment
Preset imported_preset(const std::string& name, const std::vector<std::string>& assignments);

}  // namespace traverse::pipeline
