#include "traverse/loam/scan_features.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace traverse::loam {
namespace {

using ::testing::ElementsAre;

TEST(Thinned, KeepsTheFirstPointOfEachVoxelInOrder) {
  lidar::TimedPoints points;
  points.push_back(0.9F, 0, 0, 0.1F);
  points.push_back(0.1F, 0, 0, 0.2F);  // same voxel as the first
  points.push_back(1.1F, 0, 0, 0.3F);
  points.push_back(-0.1F, 0, 0, 0.4F);  // below zero is another voxel
  const lidar::TimedPoints kept = thinned(points, 1);
  EXPECT_THAT(kept.x, ElementsAre(0.9F, 1.1F, -0.1F));
  EXPECT_THAT(kept.time, ElementsAre(0.1F, 0.3F, 0.4F));
}

TEST(CollectFeatures, SortsClassesIntoEdgesAndPlanesWithTheirTimes) {
  sensors::LidarScan scan;
  scan.x = {1, 2, 3, 4};
  scan.y = {1, 1, 1, 1};
  scan.z = {0, 0, 0, 0};
  scan.time = {0.01F, 0.02F, 0.03F, 0.04F};
  scan.ring = {0, 1, 2, 3};
  sensors::LidarProfile profile;
  profile.min_range_m = 0.1;
  const lidar::ScanLines lines = lidar::organise(scan, profile);
  Features features;
  features.classes = {lidar::FeatureClass::kSharp, lidar::FeatureClass::kFlat,
                      lidar::FeatureClass::kLessSharp, lidar::FeatureClass::kLessFlat};
  const ScanFeatures found = collect_features(scan, profile, lines, features, ThinningOptions{});
  // Rings in bit-reversed order: 0, 2, 1, 3.
  EXPECT_THAT(found.edges.x, ElementsAre(1, 3));
  EXPECT_THAT(found.planar.x, ElementsAre(2, 4));
  EXPECT_THAT(found.edges.time, ElementsAre(0.01F, 0.03F));
  EXPECT_TRUE(found.timed);
  profile.time_source = sensors::TimeSource::kNone;
  EXPECT_FALSE(collect_features(scan, profile, lines, features, ThinningOptions{}).timed);
}

}  // namespace
}  // namespace traverse::loam
