#include "traverse/loam/sweep_features.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "traverse/loam/scan_features.hpp"

#include "lidar/simulated_drive.hpp"

namespace traverse::loam {
namespace {

class SweepFeaturesTest : public ::testing::Test {
 protected:
  testing::SimulatedDrive drive{simulation::street(60, 1), 1, 10};
  const sensors::LidarScan& scan = drive.scans[0];
  const sensors::LidarProfile& profile = drive.scanner.profile;
  lidar::ScanLines lines = lidar::organise(scan, profile);
  Features features = extract_features(lines, FeatureOptions{});
  SweepFeatures sweep = collect_sweep(scan, profile, lines, features, 0.2);
};

TEST_F(SweepFeaturesTest, TheBestPointsAskAndTheGoodOnesAnswer) {
  EXPECT_EQ(sweep.sharp.size(), features.count(lidar::FeatureClass::kSharp));
  EXPECT_EQ(sweep.flat.size(), features.count(lidar::FeatureClass::kFlat));
  EXPECT_EQ(sweep.edges.size(), features.count(lidar::FeatureClass::kSharp) +
                                    features.count(lidar::FeatureClass::kLessSharp));
  EXPECT_GT(sweep.planar.size(), sweep.flat.size());
  EXPECT_LT(sweep.planar.size(), features.count(lidar::FeatureClass::kLessFlat) / 2) << "thinned";
}

TEST_F(SweepFeaturesTest, PointsKeepTheirLineAndTime) {
  for (const LinedPoints* lined : {&sweep.edges, &sweep.planar}) {
    ASSERT_EQ(lined->line.size(), lined->size());
    EXPECT_TRUE(std::is_sorted(lined->line.begin(), lined->line.end()));
    // The simulated beams tell the line of a point by its elevation, its time by its azimuth.
    for (std::size_t i = 0; i < lined->size(); i += 50) {
      const Eigen::Vector3d p = lined->points.point(i);
      const double elevation = std::atan2(p.z(), p.head<2>().norm()) * 180 / 3.14159265358979;
      EXPECT_NEAR(elevation, profile.elevations_deg[lined->line[i]], 1e-3);
      const double fraction = 0.5 * (1 - std::atan2(p.y(), p.x()) / 3.14159265358979);
      EXPECT_NEAR(lined->points.time[i], (fraction - 0.5) * profile.sweep_s, 1e-6);
    }
  }
}

TEST_F(SweepFeaturesTest, ThinningIsLineByLine) {
  // The same cube may hold points of several lines: they make the triangles of planes.
  const SweepFeatures coarse = collect_sweep(scan, profile, lines, features, 1000);
  // Cubes meet at the sensor, so a line has at most four, above or below the horizon.
  EXPECT_GT(coarse.planar.size(), lines.line_count());
  EXPECT_LE(coarse.planar.size(), 4 * lines.line_count());
}

TEST(SweepFeatures, AnEmptyScanHasNone) {
  const SweepFeatures sweep = collect_sweep(sensors::LidarScan{}, sensors::LidarProfile{},
                                            lidar::ScanLines{}, Features{}, 0.2);
  EXPECT_EQ(sweep.sharp.size() + sweep.flat.size() + sweep.edges.size() + sweep.planar.size(), 0U);
}

}  // namespace
}  // namespace traverse::loam
