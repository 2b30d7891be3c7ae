#include "traverse/sensors/sweep_timing.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace traverse::sensors {
namespace {

LidarProfile kitti_timing() {
  LidarProfile profile;
  profile.time_source = TimeSource::kAzimuth;
  profile.sweep_s = 0.1033;
  return profile;
}

TEST(SweepTiming, FollowsKittisClockwiseHead) {
  const LidarProfile profile = kitti_timing();
  for (const double azimuth : {-3.0, -1.0, 0.0, 0.5, 3.1}) {
    EXPECT_NEAR(sweep_fraction(azimuth, profile), 0.5 * (1 - azimuth / std::numbers::pi), 1e-14);
  }
}

TEST(SweepTiming, CounterclockwiseRunsTheOtherWay) {
  LidarProfile profile = kitti_timing();
  profile.rotation = Rotation::kCounterclockwise;
  EXPECT_NEAR(sweep_fraction(std::numbers::pi / 2, profile), 0.75, 1e-14);
}

TEST(SweepTiming, StampIsTheMomentTheHeadFacesForward) {
  LidarScan scan;
  scan.x = {1, 0, 0};
  scan.y = {0, 1, -1};
  scan.z = {0, 0, 0};
  const auto times = point_times(scan, kitti_timing());
  ASSERT_EQ(times.size(), 3U);
  EXPECT_FLOAT_EQ(times[0], 0);
  EXPECT_FLOAT_EQ(times[1], -0.1033F / 4);  // left: before the stamp
  EXPECT_FLOAT_EQ(times[2], 0.1033F / 4);
}

TEST(SweepTiming, UnknownTimesAreEmptyNotZero) {
  LidarScan scan;
  scan.x = scan.y = scan.z = {1};
  LidarProfile profile;
  profile.time_source = TimeSource::kNone;
  EXPECT_TRUE(point_times(scan, profile).empty());
  profile.time_source = TimeSource::kData;
  EXPECT_TRUE(point_times(scan, profile).empty());
}

}  // namespace
}  // namespace traverse::sensors
