#include "traverse/sensors/steady_sweeps.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace traverse::sensors {
namespace {

geometry::Stamp at(double seconds) { return geometry::Stamp::from_seconds(seconds); }

LidarProfile with_own_times() {
  LidarProfile profile;
  profile.time_source = TimeSource::kData;
  return profile;
}

/// What sweeps of 0.1 s with these stamps teach, points from 0 to 0.0997 s.
SteadySweeps taught(const std::vector<double>& stamps_s) {
  SteadySweeps sweeps(with_own_times());
  for (const double stamp : stamps_s) sweeps.learn(at(stamp), 0, 0.0997);
  return sweeps;
}

TEST(SteadySweeps, StampsOfArrivalDoNotChangeTheInterval) {
  const std::vector<double> late{-0.016, 0.105, 0.167, 0.313, 0.423, 0.491, 0.609,
                                 0.705,  0.792, 0.883, 0.960, 1.128, 1.199, 1.340};
  const SteadySweeps sweeps = taught(late);
  for (std::size_t i = 1; i < late.size(); ++i) {
    EXPECT_NEAR(sweeps.interval(at(late[i - 1]), at(late[i])), 0.1, 0.008) << i;
  }
}

TEST(SteadySweeps, ALostScanIsCountedAmongJitter) {
  const std::vector<double> stamps{0,     0.104, 0.193, 0.308, 0.395,
                                   0.502, 0.706, 0.794, 0.905, 0.993};
  const SteadySweeps sweeps = taught(stamps);
  EXPECT_NEAR(sweeps.interval(at(0.502), at(0.706)), 0.2, 0.012);
  EXPECT_NEAR(sweeps.interval(at(0.706), at(0.794)), 0.1, 0.006);
}

TEST(SteadySweeps, SteadyStampsAreTakenAsTheyAre) {
  const std::vector<double> stamps{0, 0.1001, 0.2, 0.3002, 0.4, 0.5001, 0.8};
  const SteadySweeps sweeps = taught(stamps);
  EXPECT_NEAR(sweeps.interval(at(0.2), at(0.3002)), 0.1002, 1e-9);
  EXPECT_NEAR(sweeps.interval(at(0.5001), at(0.8)), 0.2999, 1e-9);
}

TEST(SteadySweeps, SweepsWithPausesAreTakenAsStamped) {
  SteadySweeps sweeps(with_own_times());  // a camera-like lidar that is triggered
  const std::vector<double> stamps{0, 0.2, 0.5, 0.6, 0.9, 1.3, 1.4};
  for (const double stamp : stamps) sweeps.learn(at(stamp), 0, 0.03);
  EXPECT_NEAR(sweeps.interval(at(0.6), at(0.9)), 0.3, 1e-9);
}

TEST(SteadySweeps, KnowsAScanWithoutTimesAndTheUsualMiddle) {
  const SteadySweeps sweeps = taught({0, 0.1, 0.2});
  EXPECT_TRUE(sweeps.lacks_times(0.05, 0.05));
  EXPECT_FALSE(sweeps.lacks_times(0.01, 0.09));
  EXPECT_NEAR(sweeps.usual_middle_s(), 0.0997 / 2, 1e-12);
}

}  // namespace
}  // namespace traverse::sensors
