#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dataset/made_recordings.hpp"

namespace traverse::dataset {
namespace {

namespace fs = std::filesystem;
using namespace traverse::testing;  // made recordings

// Debian's package mrpt-common.
const fs::path kDatasets = "/usr/share/mrpt/datasets";

TEST(PackagedRawlogs, AVlp16AndItsRangeImageShowTheSameRoom) {
  if (!fs::exists(kDatasets / "rot_scan_velodyne.rawlog")) {
    GTEST_SKIP() << "the package mrpt-common is not installed";
  }
  const auto packets = open(kDatasets / "test_velodyne_VLP16.rawlog");
  const auto from_packets = read_scans(*packets).at(0);
  const auto from_image = read_scans(*open(kDatasets / "rot_scan_velodyne.rawlog")).at(0);
  ASSERT_EQ(from_packets->size(), 22591U);
  ASSERT_EQ(from_image->size(), 11305U);
  EXPECT_EQ(packets->info().rig.sensors.at(0).lidar->rings, 16);
  // MRPT made the image of every other firing, all of a packet at one time.
  const auto is_of_image = [](const sensors::LidarScan& scan, std::size_t i) {
    constexpr double kFiring_s = 55.296e-6;
    constexpr double kLaser_s = 2.304e-6;
    return std::lround((scan.time[i] - kLaser_s * scan.ring[i]) / kFiring_s) % 2 == 0;
  };
  const auto all = [](const sensors::LidarScan&, std::size_t) { return true; };
  // Same returns, in another order: compare each ring's number, centre of gravity and mean time.
  for (std::uint16_t ring = 0; ring < 16; ++ring) {
    int count = 0;
    const auto mean = [&](const sensors::LidarScan& scan, const auto& is_taken) {
      Eigen::Vector4d sum = Eigen::Vector4d::Zero();
      count = 0;
      for (std::size_t i = 0; i < scan.size(); ++i) {
        if (scan.ring[i] != ring || !is_taken(scan, i)) continue;
        sum += Eigen::Vector4d(scan.x[i], scan.y[i], scan.z[i], 100 * scan.time[i]);
        ++count;
      }
      return Eigen::Vector4d(sum / count);
    };
    const Eigen::Vector4d of_image = mean(*from_image, all);
    const int in_image = count;
    EXPECT_LT((mean(*from_packets, is_of_image) - of_image).norm(), 0.2) << ring;
    EXPECT_EQ(count, in_image) << ring;
  }
}

TEST(PackagedRawlogs, SensoryFramesOfALongRun) {
  const fs::path file = kDatasets / "graphslam-engine-demos/action_observations_map/simul.rawlog";
  if (!fs::exists(file)) GTEST_SKIP() << "the package mrpt-common is not installed";
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  const auto source = open(file);
  const auto all = read_all(*source);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(all.size(), 3465U);  // 1733 scans and, each but the last, what the wheels did
  EXPECT_THAT(skipped_in(*source), ::testing::IsEmpty());
  EXPECT_EQ(source->info().rig.first(sensors::SensorKind::kPlanarLaser)->label, "LASER_SIM");
  // What MRPT's ground-truth file ends with: the odometry is within its drift of it.
  const auto& last = std::get<sensors::WheelOdometry>(all.at(all.size() - 2));
  EXPECT_GT(last.T_odom_body->translation.norm(), 0.1);
}

TEST(PackagedRawlogs, GnssAlone) {
  if (!fs::exists(kDatasets / "test_rtk_path.rawlog")) {
    GTEST_SKIP() << "the package mrpt-common is not installed";
  }
  const auto source = open(kDatasets / "test_rtk_path.rawlog");
  const auto all = read_all(*source);
  EXPECT_EQ(all.size(), 691U);
  EXPECT_NEAR(std::get<sensors::GnssFix>(all[0]).latitude_deg, 36.7, 0.2);
}

}  // namespace
}  // namespace traverse::dataset
