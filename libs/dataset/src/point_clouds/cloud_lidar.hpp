#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "traverse/dataset/open_recording.hpp"
#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/sensors/lidar_scan.hpp"

#include "point_clouds/scan_files.hpp"
#include "recording/statements.hpp"

namespace traverse::dataset {

/// Reads one file. \throws files::InputError if it cannot be used.
using CloudReader = std::function<PointCloud(const std::filesystem::path&)>;
using ScanReader = std::function<sensors::LidarScan(const ScanFile&)>;

/// Finds out from a few of the scans which field holds what, mounts the lidar in the origin of the
/// body with the profile that follows, or the stated one, and notes in the facts what it was and
/// why. \param info whose `path` is the folder and whose `motion_compensated` is known
/// \returns what reads one scan
/// \throws files::InputError if none of the scans can be read
ScanReader mount_cloud_lidar(RecordingInfo& info, const std::string& label,
                             const std::vector<ScanFile>& scans, CloudReader read,
                             const Statements& statements, const OpenOptions& options);

}  // namespace traverse::dataset
