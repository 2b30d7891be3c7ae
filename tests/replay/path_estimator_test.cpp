#include "path_estimator.hpp"

#include <gtest/gtest.h>

namespace traverse::replay {
namespace {

using geometry::Stamp;

TEST(PathEstimator, FollowsTheOdometryFromTheFirstReading) {
  PathEstimator estimator("laser");
  sensors::WheelOdometry odometry;
  odometry.T_odom_body = geometry::Pose3::identity();
  odometry.T_odom_body->translation = {5, 1, 0};
  EXPECT_TRUE(estimator.process(odometry).empty());
  odometry.T_odom_body->translation = {7, 1, 0};
  EXPECT_TRUE(estimator.process(odometry).empty());
  auto scan = std::make_shared<sensors::PlanarScan>();
  scan->sensor = "laser";
  scan->stamp = Stamp::from_seconds(3);
  const auto frames = estimator.process(std::shared_ptr<const sensors::PlanarScan>(scan));
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].stamp, Stamp::from_seconds(3));
  EXPECT_TRUE(frames[0].T_map_body.translation.isApprox(Eigen::Vector3d(2, 0, 0)));
}

TEST(PathEstimator, SatelliteFixesAreEastNorthUp) {
  PathEstimator estimator("gps");
  sensors::GnssFix fix;
  fix.sensor = "gps";
  fix.latitude_deg = 45;
  fix.longitude_deg = 9;
  fix.altitude_m = 100;
  estimator.process(fix);
  fix.latitude_deg += 1e-4;
  fix.longitude_deg += 1e-4;
  fix.altitude_m = 101;
  const auto frames = estimator.process(fix);
  ASSERT_EQ(frames.size(), 1U);
  // A degree at 45 degrees north is 111 131.8 m of latitude and 78 846.8 m of longitude on WGS84;
  // at 100 m height 1.6e-5 more.
  const Eigen::Vector3d p = frames[0].T_map_body.translation;
  EXPECT_NEAR(p.x(), 7.88480, 2e-3);
  EXPECT_NEAR(p.y(), 11.1134, 2e-3);
  EXPECT_NEAR(p.z(), 1, 1e-3);
}

}  // namespace
}  // namespace traverse::replay
