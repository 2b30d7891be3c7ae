#include "traverse/loam/imu_prediction.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "geometry/random_motion.hpp"
#include "loam/simulated_gyro.hpp"

namespace traverse::loam {
namespace {

using geometry::Stamp;

sensors::ImuSample sample(double seconds, const Eigen::Vector3d& rate) {
  return {Stamp::from_seconds(seconds), "imu", rate, {0, 0, 9.81}};
}

ImuPrediction with_rate(const Eigen::Vector3d& rate, double first_s, double last_s) {
  ImuPrediction imu({true, 0.1});
  for (int i = 0; i * 0.01 <= last_s - first_s + 1e-9; ++i)
    imu.observe(sample(first_s + i * 0.01, rate));
  return imu;
}

const Eigen::Vector3d kRate(0.1, -0.2, 0.9);

TEST(ImuPrediction, AConstantRateTurnsByRateTimesTime) {
  const ImuPrediction imu = with_rate(kRate, 0, 1);
  const auto turn = imu.rotation(Stamp::from_seconds(0.123), Stamp::from_seconds(0.777));
  ASSERT_TRUE(turn);
  EXPECT_LT((*turn - kRate * (0.777 - 0.123)).norm(), 1e-9);
}

TEST(ImuPrediction, FollowsASwervingDriveToItsEnd) {
  simulation::Drive drive;
  drive.amplitude_m = 3;
  drive.wavelength_m = 30;
  drive.sway = 0.05;
  ImuPrediction imu({true, 0.1});
  for (const auto& each : testing::simulated_gyro(drive, 0, 3)) imu.observe(each);
  for (double from = 0; from < 2.6; from += 0.37) {
    const auto turn = imu.rotation(Stamp::from_seconds(from), Stamp::from_seconds(from + 0.4));
    ASSERT_TRUE(turn);
    const Eigen::Matrix3d truth =
        drive.pose(from).rotation.transpose() * drive.pose(from + 0.4).rotation;
    EXPECT_GT(geometry::angle_of(truth), 0.01);
    EXPECT_LT((*turn - geometry::log_so3(truth)).norm(), 1e-4) << from;  // trapezoids of 10 ms
  }
}

TEST(ImuPrediction, HoldsTheOuterRatesForNoLongerThanTheGap) {
  const ImuPrediction imu = with_rate(kRate, 1, 2);
  const auto turn = imu.rotation(Stamp::from_seconds(0.95), Stamp::from_seconds(2.05));
  ASSERT_TRUE(turn);
  EXPECT_LT((*turn - kRate * 1.1).norm(), 1e-9);
  EXPECT_FALSE(imu.rotation(Stamp::from_seconds(0.85), Stamp::from_seconds(1.5)));
  EXPECT_FALSE(imu.rotation(Stamp::from_seconds(1.5), Stamp::from_seconds(2.15)));
  EXPECT_FALSE(imu.rotation(Stamp::from_seconds(1.6), Stamp::from_seconds(1.5)));
}

TEST(ImuPrediction, AGapWithinTheIntervalTellsNothing) {
  ImuPrediction imu = with_rate(kRate, 0, 1);
  imu.observe(sample(1.2, kRate));
  EXPECT_FALSE(imu.rotation(Stamp::from_seconds(0.9), Stamp::from_seconds(1.2)));
  EXPECT_TRUE(imu.rotation(Stamp::from_seconds(0.9), Stamp::from_seconds(1.0)));
}

TEST(ImuPrediction, SamplesThatCannotBeUsedAreIgnored) {
  ImuPrediction imu = with_rate(kRate, 0, 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  imu.observe(sample(1.01, {nan, 0, 0}));
  imu.observe(sample(0.5, {9, 9, 9}));
  imu.observe(sample(1.0, {9, 9, 9}));
  const auto turn = imu.rotation(Stamp::from_seconds(0.2), Stamp::from_seconds(1.05));
  ASSERT_TRUE(turn);
  EXPECT_LT((*turn - kRate * 0.85).norm(), 1e-9);
}

TEST(ImuPrediction, WithoutAnImuOrWhenItIsNotToBeUsedTellsNothing) {
  EXPECT_FALSE(ImuPrediction({true, 0.1}).rotation(Stamp{0}, Stamp{1}));
  ImuPrediction unused({false, 0.1});
  unused.observe(sample(0, kRate));
  EXPECT_FALSE(unused.rotation(Stamp{0}, Stamp{1}));
}

TEST(ImuPrediction, ForgettingKeepsWhatLaterIntervalsNeed) {
  ImuPrediction imu = with_rate(kRate, 0, 1);
  imu.forget_before(Stamp::from_seconds(0.505));
  const auto turn = imu.rotation(Stamp::from_seconds(0.505), Stamp::from_seconds(0.9));
  ASSERT_TRUE(turn);
  EXPECT_LT((*turn - kRate * 0.395).norm(), 1e-9);
  EXPECT_FALSE(imu.rotation(Stamp::from_seconds(0.3), Stamp::from_seconds(0.9)));
}

}  // namespace
}  // namespace traverse::loam
