#include "traverse/sensors/rings.hpp"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace traverse::sensors {
namespace {

using ::testing::ElementsAre;

/// Three rings of eight points each, stored ring after ring, counterclockwise from ahead.
LidarScan three_rings() {
  LidarScan scan;
  for (const double elevation_deg : {-10.0, 0.0, 10.0}) {
    for (int i = 0; i < 8; ++i) {
      const double azimuth = (i + 0.25) * std::numbers::pi / 4;
      const double elevation = elevation_deg * std::numbers::pi / 180;
      scan.x.push_back(static_cast<float>(10 * std::cos(elevation) * std::cos(azimuth)));
      scan.y.push_back(static_cast<float>(10 * std::cos(elevation) * std::sin(azimuth)));
      scan.z.push_back(static_cast<float>(10 * std::sin(elevation)));
    }
  }
  return scan;
}

void expect_eight_points_a_ring(const RingAssignment& rings) {
  EXPECT_EQ(rings.ring_count, 3U);
  for (std::size_t i = 0; i < rings.ring.size(); ++i) EXPECT_EQ(rings.ring[i], i / 8) << i;
}

TEST(Rings, StorageOrderChangesRingWhereTheAzimuthWraps) {
  LidarProfile profile;
  profile.ring_source = RingSource::kStorageOrder;
  expect_eight_points_a_ring(assign_rings(three_rings(), profile));
}

TEST(Rings, AMissingReturnDoesNotHideTheWrap) {
  LidarScan scan = three_rings();
  scan.x[7] = scan.y[7] = scan.z[7] = 0;  // the last point of ring 0
  LidarProfile profile;
  profile.ring_source = RingSource::kStorageOrder;
  expect_eight_points_a_ring(assign_rings(scan, profile));
}

TEST(Rings, ElevationTakesTheNearestBeamAlsoBelowTheLowest) {
  LidarProfile profile;
  profile.ring_source = RingSource::kElevation;
  profile.elevations_deg = {-8, 0, 8};
  expect_eight_points_a_ring(assign_rings(three_rings(), profile));
  profile.elevations_deg = {8, 0, -8};  // ring 0 on top
  EXPECT_EQ(assign_rings(three_rings(), profile).ring.front(), 2);
}

TEST(Rings, StoredNumbersAreTakenAsTheyAreEvenBeyondTheProfile) {
  LidarScan scan;
  scan.x = scan.y = scan.z = {1, 1, 1};
  scan.ring = {0, 70, 3};
  LidarProfile profile;
  profile.rings = 64;
  const RingAssignment rings = assign_rings(scan, profile);
  EXPECT_THAT(rings.ring, ElementsAre(0, 70, 3));
  EXPECT_EQ(rings.ring_count, 71U);
}

TEST(Rings, SaysWhenThereAreNone) {
  LidarProfile profile;
  EXPECT_THROW(assign_rings(three_rings(), profile), NoRings);
  profile.ring_source = RingSource::kElevation;
  EXPECT_THROW(assign_rings(three_rings(), profile), NoRings);
  profile.ring_source = RingSource::kData;
  EXPECT_EQ(assign_rings(LidarScan{}, profile).ring_count, 0U);
}

}  // namespace
}  // namespace traverse::sensors
