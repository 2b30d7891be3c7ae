#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/config/document.hpp"
#include "traverse/dataset/source.hpp"

namespace traverse::dataset {

/// What the user says about a recording beyond what stands beside it.
struct OpenOptions {
  /// Statements in the form of traverse.yaml, stronger than the file: from a YAML file and from
  /// --recording key=value on the command line.
  std::optional<std::filesystem::path> statements_file;
  std::vector<std::string> statements;  ///< "motion_compensated=true", "lidar.sweep_s=0.1"
  /// Folder with sensors/*.yaml, where a profile named in traverse.yaml is looked up.
  std::filesystem::path share_folder;
};

/// Opens a recording, finding out its format from what is there:
///   a folder with velodyne/*.bin                          KITTI odometry
///   a folder with velodyne_points/data/*.bin              KITTI raw
///   a folder with *.pcd or *.ply                          point clouds
///   a file *.rawlog (or any file that begins like one)    MRPT rawlog
/// \throws files::InputError if it is none of these or cannot be read.
std::unique_ptr<Source> open_recording(const std::filesystem::path& path,
                                       const OpenOptions& options);

}  // namespace traverse::dataset
