#pragma once

#include <filesystem>
#include <vector>

#include "point_clouds/cloud_lidar.hpp"

namespace traverse::dataset {

/// Mounts the lidar of a folder of .bin files in one of KITTI's layouts: KITTI's own where points
/// are as KITTI has them, else as the fields of the points tell.
/// \returns what reads one scan. \throws files::InputError
ScanReader mount_kitti_lidar(RecordingInfo& info, const std::vector<std::filesystem::path>& files,
                             const std::vector<ScanFile>& scans, const Statements& statements,
                             const OpenOptions& options);

}  // namespace traverse::dataset
