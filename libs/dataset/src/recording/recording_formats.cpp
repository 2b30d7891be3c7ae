#include "traverse/dataset/recording_formats.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <system_error>
#include <vector>

#include "traverse/files/input_error.hpp"
#include "traverse/mrpt_io/rawlog_reader.hpp"

#include "bags/bag_source.hpp"
#include "captures/packet_capture.hpp"
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
  return has_files(folder, ".pcd") || has_files(folder, ".ply") || has_files(folder, ".bin");
}

bool is_csv_folder(const fs::path& folder) {
  return has_files(folder, ".csv") || has_files(folder / "imu0", ".csv") ||
         has_files(folder / "mav0/imu0", ".csv");
}

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

constexpr std::array<RecordingFormat, 12> kFormats{{
    {"KITTI odometry", true, "a folder with velodyne/*.bin",
     "the benchmark's layout: scans, times.txt, calib.txt, poses", is_kitti_odometry,
     open_kitti_odometry},
    {"KITTI raw", true, "a folder with velodyne_points/data/*.bin",
     "scans as measured with their stamps; oxts gives IMU, GNSS and the reference", is_kitti_raw,
     open_kitti_raw},
    {"point-cloud folder", true, "a folder with *.pcd, *.ply or *.bin",
     "one scan per file: PCD, PLY or bare numbers (nuScenes, MulRan, NCLT); imu.csv, gnss.csv and "
     "wheels.csv beside them",
     is_point_cloud_folder, open_point_cloud_folder},
    {"ROS 1 bags", true, "a folder with *.bag", "several bags of one recording, in order of time",
     is_folder_of_ros1_bags, open_bag},
    {"ROS 2 bag", true, "a folder with *.db3 or *.mcap",
     "split or not; SQLite, also with messages packed one by one, or MCAP", is_ros2_bag_folder,
     open_bag},
    {"CSV folder", true, "a folder with *.csv, or EuRoC's imu0/data.csv",
     "tables of IMU, GNSS and wheels, whose columns are known by name or named by a YAML file "
     "(share/recordings/comma2k19.yaml)",
     is_csv_folder, open_csv_folder},
    {"navigation log", false, "a text file that begins with IMU, ODOM or GNSS lines",
     "IMU, wheel pulses and GNSS fixes (share/recordings/wheel_imu_log.yaml)", is_navigation_log,
     open_navigation_log},
    {"ROS 1 bag", false, "*.bag, or any file that begins with #ROSBAG",
     "version 2.0: uncompressed, bz2 or lz4 chunks, in any order, with or without an index",
     is_ros1_bag_file, open_bag},
    {"ROS 2 database", false, "*.db3, or any SQLite database",
     "one file of a ROS 2 bag: messages in CDR, whose definitions are stored or built in",
     is_ros2_database, open_bag},
    {"MCAP", false, "*.mcap, or any file that begins like one",
     "messages of ROS 1 or 2: uncompressed, lz4 or zstd chunks, with or without a summary",
     is_mcap_file, open_bag},
    {"packet capture", false, "*.pcap or *.pcapng, or any file that begins like one",
     "packets of a Velodyne, a Hesai or an Ouster (with its metadata beside), their IMUs and fixes",
     is_packet_capture, open_packet_capture},
    {"MRPT rawlog", false, "*.rawlog, or any file that begins like one",
     "gzip or not, observations or sensory frames, externally stored or not", is_rawlog,
     open_rawlog},
}};

}  // namespace

std::span<const RecordingFormat> recording_formats() { return kFormats; }

std::vector<fs::path> recordings_in(const fs::path& folder) {
  constexpr std::size_t kMostEntries = 200;
  std::vector<fs::path> entries;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder, failure)) {
    entries.push_back(entry.path());
    if (entries.size() == kMostEntries) break;
  }
  std::sort(entries.begin(), entries.end());
  std::vector<fs::path> recordings;
  for (const fs::path& entry : entries) {
    const bool is_folder = fs::is_directory(entry, failure);
    // Folders of results have clouds too.
    if (fs::exists(entry / "run.json", failure) || fs::exists(entry / "map.json", failure))
      continue;
    for (const RecordingFormat& format : kFormats) {
      if (format.is_folder != is_folder) continue;
      try {
        if (!format.recognises(entry)) continue;
        recordings.push_back(entry);
        break;
      } catch (const files::InputError&) {  // what cannot be read is none to be named
      } catch (const fs::filesystem_error&) {
      }
    }
  }
  return recordings;
}

}  // namespace traverse::dataset
