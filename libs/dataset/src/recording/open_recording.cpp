#include "traverse/dataset/open_recording.hpp"

#include "traverse/files/input_error.hpp"

#include "navigation_log/navigation_log.hpp"
#include "point_clouds/scan_files.hpp"
#include "rawlog/rawlog_source.hpp"
#include "recording/folder_opening.hpp"

namespace traverse::dataset {

using files::InputError;
using files::Place;

namespace {

namespace fs = std::filesystem;

constexpr const char* kFolders =
    "a recording: a folder with velodyne/*.bin (KITTI odometry), velodyne_points/data/*.bin "
    "(KITTI raw), or *.pcd, *.ply or *.csv files";

std::unique_ptr<Source> open_folder(const fs::path& folder, const OpenOptions& options) {
  if (!files_with_extension(folder / "velodyne", ".bin").empty()) {
    return open_kitti_odometry(folder, options);
  }
  if (!files_with_extension(folder / "velodyne_points/data", ".bin").empty()) {
    return open_kitti_raw(folder, options);
  }
  if (!files_with_extension(folder, ".pcd").empty() ||
      !files_with_extension(folder, ".ply").empty()) {
    return open_point_cloud_folder(folder, options);
  }
  if (!files_with_extension(folder, ".csv").empty()) return open_csv_folder(folder, options);
  throw InputError(folder, Place::whole_file(), kFolders,
                   fs::is_empty(folder) ? "an empty folder" : "a folder with none of these");
}

}  // namespace

std::unique_ptr<Source> open_recording(const fs::path& path, const OpenOptions& options) {
  std::error_code failure;
  const fs::path whole = path.has_filename() ? path : path.parent_path();  // "drive/" is "drive"
  if (!fs::exists(whole, failure)) {
    throw InputError(path, Place::whole_file(), "a recording",
                     failure ? failure.message() : "no such file or folder");
  }
  try {
    if (fs::is_directory(whole)) return open_folder(whole, options);
    if (is_navigation_log(whole)) return open_navigation_log(whole, options);
    return open_rawlog(whole, options);
  } catch (const fs::filesystem_error& error) {
    throw InputError(error.path1(), Place::whole_file(), "a readable recording",
                     error.code().message());
  }
}

}  // namespace traverse::dataset
