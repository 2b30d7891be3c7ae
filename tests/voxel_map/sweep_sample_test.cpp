#include "traverse/voxel_map/sweep_sample.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "traverse/parallel/workers.hpp"
#include "traverse/sensors/rings.hpp"
#include "traverse/sensors/sweep_timing.hpp"
#include "traverse/voxel_map/used_points.hpp"

#include "lidar/simulated_drive.hpp"

namespace traverse::voxel_map {
namespace {

TEST(FastAzimuth, IsThatOfAtan2) {
  for (double azimuth = -3.1415; azimuth < 3.1415; azimuth += 0.001) {
    const auto x = static_cast<float>(7 * std::cos(azimuth));
    const auto y = static_cast<float>(7 * std::sin(azimuth));
    EXPECT_NEAR(fast_azimuth(x, y), azimuth, 1.5e-5) << azimuth;
  }
  EXPECT_EQ(fast_azimuth(0, 0), 0);
}

class SampleOfAStreet : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    drive_ = new testing::SimulatedDrive(simulation::street(20, 1), 1, 0);
  }
  static void TearDownTestSuite() { delete drive_; }
  static const sensors::LidarScan& scan() { return drive_->scans[0]; }
  static sensors::LidarProfile profile() { return drive_->scanner.profile; }
  static inline testing::SimulatedDrive* drive_ = nullptr;
};

TEST_F(SampleOfAStreet, IsTheSameForAnyNumberOfThreads) {
  parallel::Workers one(1);
  parallel::Workers four(4);
  const SweepSample a = sample_sweep(scan(), profile(), {}, one);
  const SweepSample b = sample_sweep(scan(), profile(), {}, four);
  ASSERT_GT(a.planar.size(), 1000U);
  ASSERT_GT(a.edges.size(), 100U);
  EXPECT_EQ(a.surface.x, b.surface.x);
  EXPECT_EQ(a.planar.source, b.planar.source);
  EXPECT_EQ(a.planar.z, b.planar.z);
  EXPECT_EQ(a.edges.time, b.edges.time);
}

TEST_F(SampleOfAStreet, TimesAreThoseOfThePointClock) {
  parallel::Workers workers(1);
  sensors::LidarProfile by_azimuth = profile();
  by_azimuth.time_source = sensors::TimeSource::kAzimuth;
  for (const auto rotation :
       {sensors::Rotation::kClockwise, sensors::Rotation::kCounterclockwise}) {
    for (const double seam : {180.0, 0.0, -90.0}) {
      by_azimuth.rotation = rotation;
      by_azimuth.seam_azimuth_deg = seam;
      const SweepSample sample = sample_sweep(scan(), by_azimuth, {}, workers);
      const sensors::PointClock clock(scan(), by_azimuth);
      for (std::size_t i = 0; i < sample.surface.size(); ++i) {
        // A mean of neighbours need not have quite the azimuth of the one in the middle.
        EXPECT_NEAR(sample.surface.time[i], clock(sample.surface.source[i]), 2e-4);
      }
    }
  }
}

TEST_F(SampleOfAStreet, TheRegistrationSetHasOnePointACube) {
  parallel::Workers workers(1);
  const SweepSample sample = sample_sweep(scan(), profile(), {}, workers);
  std::set<std::array<int, 3>> cubes;
  for (std::size_t i = 0; i < sample.planar.size(); ++i) {
    const auto cell = [](float v) { return static_cast<int>(std::floor(2 * v)); };
    cubes.insert({cell(sample.planar.x[i]), cell(sample.planar.y[i]), cell(sample.planar.z[i])});
  }
  EXPECT_EQ(cubes.size(), sample.planar.size());
}

TEST_F(SampleOfAStreet, CountsAndClassesAgree) {
  parallel::Workers workers(1);
  const SweepSample sample = sample_sweep(scan(), profile(), {}, workers);
  const auto counts = sample.class_counts();
  EXPECT_EQ(counts[static_cast<std::size_t>(lidar::FeatureClass::kSharp)], sample.edges.size());
  EXPECT_EQ(counts[static_cast<std::size_t>(lidar::FeatureClass::kFlat)], sample.planar.size());
  const lidar::CorrectedScan used = used_points(scan(), profile(), geometry::Twist::Zero());
  EXPECT_EQ(used.x.size(), scan().size() - sample.dropped.total());
  const auto classes = classes_of(used, sample);
  ASSERT_EQ(classes.size(), used.x.size());
  const auto sharp = std::count(classes.begin(), classes.end(), lidar::FeatureClass::kSharp);
  EXPECT_GT(sharp, 0);
  EXPECT_LE(static_cast<std::size_t>(sharp), sample.edges.size());
}

TEST_F(SampleOfAStreet, CorrectsTheElevationOfWhatItKeeps) {
  parallel::Workers workers(1);
  sensors::LidarProfile raised = profile();
  raised.vertical_correction_deg = 1;
  const SweepSample as_is = sample_sweep(scan(), profile(), {}, workers);
  const SweepSample corrected = sample_sweep(scan(), raised, {}, workers);
  ASSERT_EQ(as_is.surface.source, corrected.surface.source);
  const auto elevation = [](const SweepPoints& p, std::size_t i) {
    return std::atan2(p.z[i], std::hypot(p.x[i], p.y[i]));
  };
  for (std::size_t i = 0; i < as_is.surface.size(); i += 50) {
    EXPECT_NEAR(elevation(corrected.surface, i) - elevation(as_is.surface, i),
                std::numbers::pi / 180, 1e-5);
  }
}

TEST_F(SampleOfAStreet, WhatOneLidarSeesDoesNotStandForWhatAnotherDoes) {
  parallel::Workers workers(2);
  sensors::LidarProfile both = profile();
  const auto rings = static_cast<std::size_t>(both.rings);
  ASSERT_GT(rings, 0U);
  sensors::LidarScan scans = scan();
  both.ring_source = sensors::RingSource::kData;
  if (scans.ring.empty()) scans.ring = sensors::assign_rings(scan(), profile()).ring;
  const SweepSample alone = sample_sweep(scans, both, {}, workers);
  // The same once more, from a lidar that stands 2 m beside.
  const std::size_t n = scans.size();
  for (std::size_t i = 0; i < n; ++i) {
    scans.x.push_back(scans.x[i]);
    scans.y.push_back(scans.y[i] + 2);
    scans.z.push_back(scans.z[i]);
    if (!scans.intensity.empty()) scans.intensity.push_back(scans.intensity[i]);
    if (!scans.time.empty()) scans.time.push_back(scans.time[i]);
    scans.ring.push_back(static_cast<std::uint16_t>(scans.ring[i] + rings));
  }
  both.rings *= 2;
  both.lidars_in_scan = {{0, {0, 0, 0}}, {rings, {0, 2, 0}}};
  const SweepSample two = sample_sweep(scans, both, {}, workers);
  ASSERT_EQ(two.surface.size(), 2 * alone.surface.size());
  ASSERT_EQ(two.edges.size(), 2 * alone.edges.size());
  for (std::size_t i = 0; i < alone.edges.size(); ++i) {
    const std::size_t k = alone.edges.size() + i;
    EXPECT_NEAR(two.edges.x[k], alone.edges.x[i], 1e-4);
    EXPECT_NEAR(two.edges.y[k], alone.edges.y[i] + 2, 1e-4);
    EXPECT_NEAR(two.edges.range[k], alone.edges.range[i], 1e-4);
  }
  // Cubes of the one are not those of the other, so that they hold about as many, not the same.
  EXPECT_GT(two.planar.size(), 1.9 * static_cast<double>(alone.planar.size()));
  EXPECT_TRUE(std::equal(alone.planar.x.begin(), alone.planar.x.end(), two.planar.x.begin()));
}

}  // namespace
}  // namespace traverse::voxel_map
