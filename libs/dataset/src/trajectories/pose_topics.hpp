#pragma once

#include <filesystem>
#include <string>

#include "traverse/dataset/trajectory_files.hpp"

namespace traverse::dataset {

/// The poses of a topic of a bag, by the stamps of their headers.
/// \param topic empty: the only one with poses
/// \throws files::InputError if there is no such topic, or several where none is named; for a
/// message that is not read
void read_pose_topic(const std::filesystem::path& file, const std::string& topic,
                     const PoseTaker& take, TrajectoryReading& reading);

}  // namespace traverse::dataset
