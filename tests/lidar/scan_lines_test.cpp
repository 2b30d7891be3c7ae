#include "traverse/lidar/scan_lines.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace traverse::lidar {
namespace {

using ::testing::ElementsAre;

sensors::LidarProfile profile_with_rings() {
  sensors::LidarProfile profile;
  profile.rings = 4;
  profile.min_range_m = 1;
  profile.max_range_m = 50;
  return profile;
}

/// Points along x with a ring each.
sensors::LidarScan scan_of(const std::vector<float>& x, const std::vector<std::uint16_t>& ring) {
  sensors::LidarScan scan;
  scan.x = x;
  scan.y.assign(x.size(), 0);
  scan.z.assign(x.size(), 0);
  scan.ring = ring;
  return scan;
}

TEST(ScanLines, GroupsByRingAndKeepsStorageOrder) {
  const ScanLines lines =
      organise(scan_of({10, 20, 11, 21, 12}, {2, 0, 2, 0, 2}), profile_with_rings());
  EXPECT_THAT(lines.line_begin, ElementsAre(0, 2, 2, 5));
  EXPECT_THAT(lines.x, ElementsAre(20, 21, 10, 11, 12));
  EXPECT_THAT(lines.source, ElementsAre(1, 3, 0, 2, 4));
  EXPECT_THAT(lines.range, ElementsAre(20, 21, 10, 11, 12));
}

TEST(ScanLines, CountsWhyPointsAreDropped) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const ScanLines lines = organise(scan_of({nan, inf, 0, 0.5F, 60, 10, 10}, {0, 0, 0, 0, 0, 4, 3}),
                                   profile_with_rings());
  EXPECT_EQ(lines.dropped.not_finite, 2U);
  EXPECT_EQ(lines.dropped.at_origin, 1U);
  EXPECT_EQ(lines.dropped.out_of_range, 2U);
  EXPECT_EQ(lines.dropped.beyond_profile_rings, 1U);
  EXPECT_EQ(lines.dropped.total(), 6U);
  EXPECT_EQ(lines.size(), 1U);
}

TEST(ScanLines, AnEmptyScanIsNoLine) {
  const ScanLines lines = organise(sensors::LidarScan{}, profile_with_rings());
  EXPECT_EQ(lines.line_count(), 0U);
  EXPECT_EQ(lines.size(), 0U);
}

TEST(ScanLines, AppliesTheProfilesVerticalCorrection) {
  sensors::LidarProfile profile = profile_with_rings();
  profile.vertical_correction_deg = 1;
  const ScanLines lines = organise(scan_of({10}, {0}), profile);
  EXPECT_NEAR(std::atan2(lines.z[0], lines.x[0]) * 180 / 3.14159265358979, 1, 1e-5);
  EXPECT_FLOAT_EQ(lines.range[0], 10);
}

}  // namespace
}  // namespace traverse::lidar
