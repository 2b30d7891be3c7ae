#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"
#include "traverse/geometry/pose3.hpp"
#include "traverse/packets/ouster_metadata.hpp"

#include "recording/statements.hpp"

namespace traverse::dataset {

/// An Ouster's metadata and where they come from.
struct OusterChoice {
  packets::OusterMetadata metadata;
  std::string from;  ///< a file or a topic
  std::string reason;
};

/// What is stated as `lidar.metadata`. \throws files::InputError
std::optional<OusterChoice> stated_ouster(const Statements& statements);

/// The metadata of the only *.json that holds such in the folder, of several the one called as the
/// recording. \throws files::InputError
std::optional<OusterChoice> ouster_beside(const std::filesystem::path& recording);

void note_ouster(const OusterChoice& choice, std::vector<Fact>& facts);

/// T_lidar_imu, where the lidar's frame is that of its points.
geometry::Pose3 ouster_imu_mounting(const packets::OusterMetadata& metadata);

}  // namespace traverse::dataset
