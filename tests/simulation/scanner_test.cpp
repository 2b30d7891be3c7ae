#include "traverse/simulation/scanner.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "traverse/simulation/worlds.hpp"

namespace traverse::simulation {
namespace {

Scanner exact_scanner() {
  Scanner scanner = demo_scanner();
  scanner.range_noise_m = 0;
  scanner.azimuth_steps = 200;
  return scanner;
}

TEST(Scanner, EveryPointLiesOnTheTunnelWhenPlacedByItsOwnMoment) {
  const AnalyticScene scene = tunnel(100);
  const Drive drive;
  const sensors::LidarScan scan = exact_scanner().scan(scene, drive, 1.0);
  ASSERT_GT(scan.size(), 5000U);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3d p =
        drive.pose(1.0 + scan.time[i]) * Eigen::Vector3d(scan.x[i], scan.y[i], scan.z[i]);
    const double to_floor_or_ceiling = std::min(std::abs(p.z()), std::abs(p.z() - 5));
    const double to_wall = std::min(std::abs(p.y() - 4), std::abs(p.y() + 4));
    EXPECT_LT(std::min(to_floor_or_ceiling, to_wall), 2e-5) << "point " << i;
  }
}

TEST(Scanner, TheSweepIsBentByMotion) {
  const AnalyticScene scene = tunnel(100);
  Drive drive;
  drive.amplitude_m = 0;
  drive.sway = 0;
  const sensors::LidarScan scan = exact_scanner().scan(scene, drive, 1.0);
  EXPECT_LT(*std::min_element(scan.time.begin(), scan.time.end()), -0.049F);
  EXPECT_GT(*std::max_element(scan.time.begin(), scan.time.end()), 0.049F);
  EXPECT_EQ(scan.ring.size(), scan.size());
}

TEST(Scanner, SkyGivesNoReturnsAndSameSeedSameBytes) {
  const AnalyticScene scene = street(50, 1);
  Scanner scanner = demo_scanner();
  scanner.azimuth_steps = 100;
  const sensors::LidarScan a = scanner.scan(scene, Drive{}, 0.5);
  const sensors::LidarScan b = scanner.scan(scene, Drive{}, 0.5);
  EXPECT_LT(a.size(), 6400U);
  EXPECT_EQ(a.x, b.x);
  scanner.seed = 2;
  EXPECT_NE(a.x, scanner.scan(scene, Drive{}, 0.5).x);
}

TEST(Drive, IsOneSmoothClosedDescription) {
  const Drive drive;
  const double h = 1e-6;
  for (const double t : {0.0, 1.7, 5.0}) {
    const Eigen::Vector3d velocity =
        (drive.pose(t + h).translation - drive.pose(t - h).translation) / (2 * h);
    EXPECT_NEAR(velocity.x(), drive.speed_mps, 1e-6);
    // The heading follows the path.
    const Eigen::Vector3d ahead = drive.pose(t).rotation.col(0);
    EXPECT_NEAR(ahead.y() / ahead.x(), velocity.y() / velocity.x(), 1e-6);
  }
}

}  // namespace
}  // namespace traverse::simulation
