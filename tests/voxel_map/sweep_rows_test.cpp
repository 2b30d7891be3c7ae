#include "traverse/voxel_map/sweep_rows.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "traverse/sensors/rings.hpp"

namespace traverse::voxel_map {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// `rings` rings of 90 points at range 10, each counterclockwise from straight ahead.
sensors::LidarScan stored_ring_after_ring(int rings) {
  sensors::LidarScan scan;
  for (int ring = 0; ring < rings; ++ring) {
    const double elevation = (2 * ring - 15) * std::numbers::pi / 180;
    for (int k = 0; k < 90; ++k) {
      const double azimuth = (4 * k + 0.5) * std::numbers::pi / 180;
      scan.x.push_back(static_cast<float>(10 * std::cos(elevation) * std::cos(azimuth)));
      scan.y.push_back(static_cast<float>(10 * std::cos(elevation) * std::sin(azimuth)));
      scan.z.push_back(static_cast<float>(10 * std::sin(elevation)));
    }
  }
  return scan;
}

sensors::LidarProfile profile_of(sensors::RingSource source, int rings) {
  sensors::LidarProfile profile;
  profile.ring_source = source;
  profile.rings = rings;
  return profile;
}

TEST(SweepRows, AScanStoredRingAfterRingIsDividedAsItsRingsAre) {
  const sensors::LidarScan scan = stored_ring_after_ring(16);
  const auto profile = profile_of(sensors::RingSource::kStorageOrder, 16);
  const SweepRows rows(scan, profile);
  const sensors::RingAssignment rings = sensors::assign_rings(scan, profile);
  ASSERT_EQ(rows.count(), 16U);
  for (std::size_t k = 0; k < rows.count(); ++k) {
    const Row row = rows.row(k);
    EXPECT_EQ(row.x, scan.x.data() + 90 * k) << "looked at, not copied";
    for (std::size_t i = 0; i < row.size; ++i) {
      EXPECT_EQ(rings.ring[row.source_of(i)], k);
      EXPECT_NEAR(row.range[i], 10, 1e-5);
    }
  }
  EXPECT_EQ(rows.dropped().total(), 0U);
}

TEST(SweepRows, UnusablePointsAreCountedByReason) {
  sensors::LidarScan scan = stored_ring_after_ring(4);
  scan.x[5] = kNan;
  scan.y[6] = std::numeric_limits<float>::infinity();
  scan.x[100] = scan.y[100] = scan.z[100] = 0;
  scan.x[101] *= 0.01F;
  scan.y[101] *= 0.01F;
  scan.z[101] *= 0.01F;
  scan.x[102] *= 1000;
  const SweepRows rows(scan, profile_of(sensors::RingSource::kStorageOrder, 4));
  EXPECT_EQ(rows.dropped().not_finite, 2U);
  EXPECT_EQ(rows.dropped().at_origin, 1U);
  EXPECT_EQ(rows.dropped().out_of_range, 2U);
  ASSERT_EQ(rows.count(), 4U);
  EXPECT_EQ(rows.row(0).size, 88U);
  EXPECT_EQ(rows.row(1).size, 89U) << "too near and too far stay in their row";
  EXPECT_EQ(rows.row(0).source_of(5), 7U);
}

TEST(SweepRows, RingsBeyondTheProfileAreLeftOut) {
  sensors::LidarScan scan = stored_ring_after_ring(5);
  EXPECT_EQ(SweepRows(scan, profile_of(sensors::RingSource::kStorageOrder, 3))
                .dropped()
                .beyond_profile_rings,
            180U);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    scan.ring.push_back(static_cast<std::uint16_t>(i / 90));
  }
  const SweepRows rows(scan, profile_of(sensors::RingSource::kData, 3));
  EXPECT_EQ(rows.count(), 3U);
  EXPECT_EQ(rows.dropped().beyond_profile_rings, 180U);
}

TEST(SweepRows, ACloudWithoutRingsIsCutIntoRowsByElevation) {
  const sensors::LidarScan ordered = stored_ring_after_ring(16);
  std::vector<std::size_t> order(ordered.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  sensors::LidarScan scan;
  for (const std::size_t i : order) {
    scan.x.push_back(ordered.x[i]);
    scan.y.push_back(ordered.y[i]);
    scan.z.push_back(ordered.z[i]);
  }
  const SweepRows rows(scan, profile_of(sensors::RingSource::kData, 16));
  EXPECT_TRUE(rows.from_range_image());
  ASSERT_EQ(rows.count(), 16U);
  for (std::size_t k = 0; k < rows.count(); ++k) {
    const Row row = rows.row(k);
    for (std::size_t i = 1; i < row.size; ++i) {
      EXPECT_GT(std::atan2(row.y[i], row.x[i]), std::atan2(row.y[i - 1], row.x[i - 1]));
    }
  }
}

TEST(SweepRows, OfSeveralLidarsEachLooksFromItsOwnPlace) {
  sensors::LidarScan scan = stored_ring_after_ring(4);
  auto profile = profile_of(sensors::RingSource::kData, 4);
  profile.lidars_in_scan = {{0, {0, 0, 0}}, {2, {3, -1, 0.5}}};
  for (std::size_t i = 0; i < scan.size(); ++i) {
    scan.ring.push_back(static_cast<std::uint16_t>(i / 90));
    if (i < 180) continue;
    scan.x[i] += 3;
    scan.y[i] -= 1;
    scan.z[i] += 0.5F;
  }
  const SweepRows rows(scan, profile);
  ASSERT_EQ(rows.count(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    const Row row = rows.row(k);
    EXPECT_EQ(row.lidar, k / 2);
    for (std::size_t i = 0; i < row.size; ++i) {
      EXPECT_NEAR(row.range[i], 10, 1e-5);
      EXPECT_NEAR(row.x[i] + row.ox, scan.x[row.source_of(i)], 1e-5);
      EXPECT_NEAR(row.y[i] + row.oy, scan.y[row.source_of(i)], 1e-5);
      EXPECT_NEAR(row.z[i] + row.oz, scan.z[row.source_of(i)], 1e-5);
    }
  }
}

TEST(SweepRows, AnEmptyScanHasNone) { EXPECT_EQ(SweepRows(sensors::LidarScan{}, {}).count(), 0U); }

}  // namespace
}  // namespace traverse::voxel_map
