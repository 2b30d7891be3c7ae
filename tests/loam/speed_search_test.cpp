#include "traverse/loam/speed_search.hpp"

#include <gtest/gtest.h>

#include "lidar/simulated_drive.hpp"

namespace traverse::loam {
namespace {

TEST(SpeedSearch, LocksOnAtEverySpeed) {
  const simulation::AnalyticScene scene = simulation::street(60, 5);
  for (const double speed : {0.0, 3.0, 11.0, 22.0, 33.0}) {
    const testing::SimulatedDrive drive(scene, 4, speed);
    std::vector<ScanFeatures> scans;
    for (const auto& scan : drive.scans) {
      const lidar::ScanLines lines = lidar::organise(scan, drive.scanner.profile);
      scans.push_back(collect_features(scan, drive.scanner.profile, lines,
                                       extract_features(lines, FeatureOptions{}),
                                       ThinningOptions{}));
    }
    const geometry::Twist velocity = find_initial_velocity(
        scans, drive.scanner.profile, ScanToMapOptions{}, SpeedSearchOptions{});
    // The path swerves, so the speed along it is a little above that along x.
    EXPECT_NEAR(velocity[3], drive.truth[1].translation.norm() / 0.1, 0.3) << "speed " << speed;
  }
}

}  // namespace
}  // namespace traverse::loam
