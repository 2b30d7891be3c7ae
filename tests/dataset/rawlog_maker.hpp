#pragma once

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/serialization/CArchive.h>

#include "dataset/made_recordings.hpp"
#include "temporary_folder.hpp"

namespace traverse::testing {

/// 2026-01-01 00:00:00 UTC plus `seconds`, in MRPT's ticks.
inline mrpt::Clock::time_point mrpt_time(double seconds) {
  return mrpt::Clock::fromDouble(1767225600) + mrpt::Clock::duration(static_cast<std::int64_t>(
                                                   seconds * 1e7 + (seconds < 0 ? -0.5 : 0.5)));
}
inline constexpr std::int64_t kMadeEpochNanoseconds = 1'767'225'600'000'000'000;

/// Writes a rawlog with MRPT itself, so that what the reader is tested on does not come from the
/// project's own writer.
class RawlogMaker {
 public:
  explicit RawlogMaker(const std::filesystem::path& file, int level = 1) {
    stream_.open(file.string(), level);
  }
  void add(const mrpt::serialization::CSerializable& object) {
    auto archive = mrpt::serialization::archiveFrom(stream_);
    archive << object;
  }
  void add_bytes(const std::string& bytes) { stream_.Write(bytes.data(), bytes.size()); }

 private:
  mrpt::io::CFileGZOutputStream stream_;
};

inline mrpt::obs::CObservationIMU made_imu(double seconds, const std::string& label = "imu") {
  mrpt::obs::CObservationIMU imu;
  imu.timestamp = mrpt_time(seconds);
  imu.sensorLabel = label;
  imu.sensorPose = mrpt::poses::CPose3D(0.1, 0.2, 0.3, 0, 0, 0);
  imu.set(mrpt::obs::IMU_X_ACC, 1);
  imu.set(mrpt::obs::IMU_Y_ACC, 2);
  imu.set(mrpt::obs::IMU_Z_ACC, 3);
  imu.set(mrpt::obs::IMU_WX, 4);
  imu.set(mrpt::obs::IMU_WY, 5);
  imu.set(mrpt::obs::IMU_WZ, 6);
  return imu;
}

/// A scan of `points` points in two rings, with times.
inline mrpt::obs::CObservationVelodyneScan made_velodyne(double seconds, std::size_t points = 6,
                                                         const std::string& label = "top") {
  mrpt::obs::CObservationVelodyneScan scan;
  scan.timestamp = mrpt_time(seconds);
  scan.sensorLabel = label;
  scan.sensorPose = mrpt::poses::CPose3D(1, 0, 2, 0, 0, 0);
  scan.minRange = 0.9;
  scan.maxRange = 100;
  for (std::size_t i = 0; i < points; ++i) {
    scan.point_cloud.x.push_back(static_cast<float>(i) + 0.1F);
    // Digits that do not compress.
    scan.point_cloud.y.push_back(
        static_cast<float>(std::sin(1e4 * static_cast<double>(i) + seconds)));
    scan.point_cloud.z.push_back(-1);
    scan.point_cloud.intensity.push_back(static_cast<std::uint8_t>(40 * i));
    scan.point_cloud.laser_id.push_back(static_cast<std::int16_t>(i % 2));
    scan.point_cloud.timestamp.push_back(mrpt_time(seconds + 0.01 * static_cast<double>(i)));
  }
  return scan;
}

/// The measurements of a rawlog that holds these objects.
template <typename... Object>
std::vector<sensors::Measurement> measurements_of(const Object&... objects) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    (maker.add(objects), ...);
  }
  return read_all(*open(folder / "a.rawlog"));
}

/// Milliseconds after the made recordings' epoch.
inline std::vector<std::int64_t> made_stamps_of(
    const std::vector<sensors::Measurement>& measurements) {
  std::vector<std::int64_t> milliseconds;
  for (const auto& measurement : measurements) {
    milliseconds.push_back((stamp_of(measurement).nanoseconds - kMadeEpochNanoseconds) / 1'000'000);
  }
  return milliseconds;
}

}  // namespace traverse::testing
