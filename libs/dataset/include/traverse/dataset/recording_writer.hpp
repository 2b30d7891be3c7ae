#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"

namespace traverse::dataset {

/// Writes a recording, one measurement at a time. Nothing is at its place before commit().
class RecordingWriter {
 public:
  virtual ~RecordingWriter() = default;

  /// \throws files::OutputError if a byte is not taken.
  virtual void add(const sensors::Measurement& measurement) = 0;

  /// A file that goes with the recording and appears with it: NAME in a folder, X.NAME beside
  /// X.rawlog. \throws files::OutputError
  virtual void add_file(const std::string& name, const std::string& text) = 0;

  /// Writes what remains and puts everything in its place. \throws files::OutputError
  virtual void commit() = 0;

  /// Measurements that the format has no place for, by what they are: "IMU samples".
  const std::map<std::string, std::size_t>& left_out() const { return left_out_; }

 protected:
  std::map<std::string, std::size_t> left_out_;
};

/// What becomes of files that are there already where new ones beside each other are to be. Those
/// of an earlier writing of the same recording are replaced, when the new ones are complete.
struct FilesThere {
  bool replace = false;  ///< those of others as well
  std::vector<std::string>
      others;  ///< names that add_file() will be given, to be looked for at once
};

struct RawlogOptions {
  int gzip_level = 1;  ///< 0 (plain) to 9
  FilesThere there{};
};

/// Writes `file` as a rawlog of observations that MRPT's own tools open, with the facts in
/// X.traverse.yaml and the reference in X.reference.tum beside it.
/// \throws files::OutputError if one of these files is there and this program did not write it.
///
/// A lidar scan becomes a CObservationVelodyneScan with only its point cloud filled: rings and
/// times, found as the profile says, go to laser_id and timestamp (ticks of 100 ns), intensity is
/// scaled to 0 .. 255. The profile that is written says that they are in the data. A fix is a GGA
/// sentence (RMC without an altitude), with its deviations in a BESTPOS and its heading in an
/// INSPVAS message of Novatel beside it. What is rounded and what has no place is in left_out().
///
/// `info` must outlive the writer: the rig of a rawlog that is being read may grow.
std::unique_ptr<RecordingWriter> write_rawlog(const std::filesystem::path& file,
                                              const RecordingInfo& info,
                                              const std::optional<Reference>& reference,
                                              const RawlogOptions& options);

enum class BagFormat { kRos1, kMcap };
enum class BagPacking { kNone, kLz4, kZstd };

struct BagOptions {
  BagFormat format = BagFormat::kMcap;
  BagPacking packing = BagPacking::kNone;  ///< of its chunks; a ROS 1 bag knows no zstd
  FilesThere there{};
};

/// Writes `file` as a ROS 1 bag, or as MCAP with the messages of ROS 2: a topic a sensor, called as
/// the sensor is, the mountings as /tf_static, with the facts in X.traverse.yaml and the reference
/// in X.reference.tum beside it.
/// \throws files::OutputError if one of these files is there and this program did not write it.
///
/// Scans are PointCloud2 (x, y, z, intensity, time in seconds after the stamp, ring: found as the
/// profile says) and LaserScan, IMU samples Imu, fixes NavSatFix, wheel odometry Odometry. What no
/// common message can hold stands in topics beside these: TOPIC/heading, TOPIC/pulses. A message is
/// logged at the stamp of its measurement.
///
/// `info` must outlive the writer, as for write_rawlog().
std::unique_ptr<RecordingWriter> write_bag(const std::filesystem::path& file,
                                           const RecordingInfo& info,
                                           const std::optional<Reference>& reference,
                                           const BagOptions& options);

/// Writes `file` as a text log with lines IMU, ODOM and GNSS (rad/s, cumulative pulses), with the
/// mountings and how to read it in X.traverse.yaml and the reference in X.reference.tum beside it.
/// It holds the first sensor of each of these kinds; wheels that count no pulses, fixes without an
/// altitude and deviations of fixes have no place in it.
std::unique_ptr<RecordingWriter> write_navigation_log(const std::filesystem::path& file,
                                                      const RecordingInfo& info,
                                                      const std::optional<Reference>& reference,
                                                      const FilesThere& there = {});

enum class ScanFolderFormat { kPcd, kPly, kKitti };

/// Writes the scans of one lidar as `folder`: scans named by their number, times.txt,
/// traverse.yaml, reference.tum and calib.txt where they are known. The body is then the lidar.
/// PCD and PLY files hold rings and times, found as the profile says; KITTI's do not. imu.csv,
/// gnss.csv and wheels.csv hold the first sensor of each of these kinds.
/// \throws std::invalid_argument if `info` has no lidar with that label.
std::unique_ptr<RecordingWriter> write_scan_folder(const std::filesystem::path& folder,
                                                   const RecordingInfo& info,
                                                   const std::optional<Reference>& reference,
                                                   const std::string& lidar,
                                                   ScanFolderFormat format);

}  // namespace traverse::dataset
