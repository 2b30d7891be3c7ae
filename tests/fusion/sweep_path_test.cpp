#include "sweep_path.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "traverse/geometry/so3.hpp"

#include "fusion/simulated_imu.hpp"

namespace traverse::fusion {
namespace {

const Eigen::Vector3d kGravity(0, 0, -testing::kGravityOfTests);

/// Shaken by hand: 3.5 rad/s about two axes, and a walk.
geometry::Pose3 shaken(double t) {
  geometry::Pose3 pose;
  pose.rotation = geometry::exp_so3({0, 0, 0.7 * std::sin(5 * t)}) *
                  geometry::exp_so3({0.2 * std::sin(9 * t), 0, 0});
  pose.translation = {1.4 * t, 0.1 * std::sin(6 * t), 0.05 * std::cos(11 * t)};
  return pose;
}

class ShakenSweep : public ::testing::Test {
 protected:
  void SetUp() override {
    const testing::LidarAndImu sensors;
    gyro_bias_ = {0.01, -0.02, 0.005};
    accelerometer_bias_ = {0.1, 0.05, -0.08};
    readings_ = testing::simulated_imu(shaken, sensors.p_lidar_imu, 0.9, 1.1, gyro_bias_,
                                       accelerometer_bias_);
    constexpr double h = 1e-4;
    middle_.stamp = geometry::Stamp::from_seconds(1);
    middle_.q_map_body = shaken(1).quaternion();
    middle_.p_map = shaken(1) * sensors.p_lidar_imu;
    middle_.v_map =
        (shaken(1 + h) * sensors.p_lidar_imu - shaken(1 - h) * sensors.p_lidar_imu) / (2 * h);
    middle_.gyro_bias = gyro_bias_;
    middle_.accelerometer_bias = accelerometer_bias_;
    path_ = SweepPath(readings_, middle_, kGravity, -sensors.p_lidar_imu, -0.05, 0.05);
  }

  Eigen::Vector3d gyro_bias_, accelerometer_bias_;
  std::vector<sensors::ImuSample> readings_;
  inertial::NavState middle_;
  SweepPath path_;
};

TEST_F(ShakenSweep, GoesAsTheLidarWent) {
  for (const double t : {-0.05, -0.033, -0.001, 0.0, 0.0005, 0.021, 0.05}) {
    const geometry::Pose3 truth = shaken(1).inverse() * shaken(1 + t);
    const geometry::Pose3 found = path_.at(t);
    EXPECT_LT((found.translation - truth.translation).norm(), 1e-3) << t;
    EXPECT_LT(geometry::angle_of(found.rotation.transpose() * truth.rotation), 1e-3) << t;
  }
}

TEST_F(ShakenSweep, PutsPointsWhereTheyAreInTheMiddle) {
  const Eigen::Vector3d p_map(12, -7, 2);
  voxel_map::SweepPoints seen;
  for (const double t : {-0.05, -0.02, 0.0, 0.037, 0.05}) {
    const Eigen::Vector3f p = (shaken(1 + t).inverse() * p_map).cast<float>();
    seen.push_back(p.x(), p.y(), p.z(), p.norm(), 0);
    seen.time.back() = static_cast<float>(t);
  }
  voxel_map::SweepPoints moved = seen;
  path_.apply(seen, moved);
  const Eigen::Vector3d truth = shaken(1).inverse() * p_map;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const Eigen::Vector3d found(moved.x[i], moved.y[i], moved.z[i]);
    EXPECT_LT((found - truth).norm(), 0.015) << seen.time[i] << " s";
  }
  EXPECT_GT((Eigen::Vector3d(seen.x[0], seen.y[0], seen.z[0]) - truth).norm(), 0.5) << "as seen";
}

TEST_F(ShakenSweep, PutsAScanWhereItIsAtItsStamp) {
  const Eigen::Vector3d p_map(12, -7, 2);
  const double stamp_s = -0.05;  // the scan is stamped at its start
  lidar::CorrectedScan scan;
  std::vector<float> times;
  for (const double after : {0.0, 0.04, 0.1}) {
    const Eigen::Vector3f p = (shaken(1 + stamp_s + after).inverse() * p_map).cast<float>();
    scan.x.push_back(p.x());
    scan.y.push_back(p.y());
    scan.z.push_back(p.z());
    times.push_back(static_cast<float>(after));
  }
  path_.apply(times, stamp_s, scan);
  const Eigen::Vector3d truth = shaken(1 + stamp_s).inverse() * p_map;
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_LT((Eigen::Vector3d(scan.x[i], scan.y[i], scan.z[i]) - truth).norm(), 0.02) << times[i];
  }
}

TEST(SweepPathOfNothing, MovesNothing) {
  const SweepPath path;
  EXPECT_TRUE(path.at(0.03).translation.isZero(0));
  EXPECT_TRUE(path.mean_velocity().isZero(0));
}

}  // namespace
}  // namespace traverse::fusion
