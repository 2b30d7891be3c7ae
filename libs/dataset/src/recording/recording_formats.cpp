#include "traverse/dataset/recording_formats.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

#include "traverse/files/input_error.hpp"
#include "traverse/mrpt_io/rawlog_reader.hpp"

#include "navigation_log/navigation_log.hpp"
#include "point_clouds/scan_files.hpp"
#include "rawlog/rawlog_source.hpp"
#include "recording/folder_opening.hpp"

namespace traverse::dataset {

namespace {

namespace fs = std::filesystem;

bool has_files(const fs::path& folder, std::string_view extension) {
  return !files_with_extension(folder, extension).empty();
}

bool is_kitti_odometry(const fs::path& folder) { return has_files(folder / "velodyne", ".bin"); }

bool is_kitti_raw(const fs::path& folder) {
  return has_files(folder / "velodyne_points/data", ".bin");
}

bool is_point_cloud_folder(const fs::path& folder) {
  return has_files(folder, ".pcd") || has_files(folder, ".ply");
}

bool is_csv_folder(const fs::path& folder) { return has_files(folder, ".csv"); }

/// A file that is called one is opened as one, whatever it holds: the reader says what is wrong.
bool is_rawlog(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".rawlog") return true;
  try {
    const mrpt_io::RawlogReader reader(file);
    return true;
  } catch (const files::InputError&) {
    return false;
  }
}

constexpr std::array<RecordingFormat, 6> kFormats{{
    {"KITTI odometry", true, "a folder with velodyne/*.bin",
     "the benchmark's layout: scans, times.txt, calib.txt, poses", is_kitti_odometry,
     open_kitti_odometry},
    {"KITTI raw", true, "a folder with velodyne_points/data/*.bin",
     "scans as measured with their stamps; oxts gives IMU, GNSS and the reference", is_kitti_raw,
     open_kitti_raw},
    {"point-cloud folder", true, "a folder with *.pcd or *.ply",
     "one scan per file: PCD (ascii, binary, compressed) or PLY (ascii, binary)",
     is_point_cloud_folder, open_point_cloud_folder},
    {"CSV folder", true, "a folder with *.csv",
     "tables of IMU, GNSS and wheels, whose columns a YAML file names "
     "(share/recordings/comma2k19.yaml)",
     is_csv_folder, open_csv_folder},
    {"navigation log", false, "a text file that begins with IMU, ODOM or GNSS lines",
     "IMU, wheel pulses and GNSS fixes (share/recordings/wheel_imu_log.yaml)", is_navigation_log,
     open_navigation_log},
    {"MRPT rawlog", false, "*.rawlog, or any file that begins like one",
     "gzip or not, observations or sensory frames, externally stored or not", is_rawlog,
     open_rawlog},
}};

}  // namespace

std::span<const RecordingFormat> recording_formats() { return kFormats; }

}  // namespace traverse::dataset
