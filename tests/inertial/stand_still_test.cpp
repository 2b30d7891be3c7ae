#include "traverse/inertial/stand_still.hpp"

#include <random>

#include <gtest/gtest.h>

#include "traverse/geometry/so3.hpp"

namespace traverse::inertial {
namespace {

constexpr double kGravity = 9.81;

/// Two seconds at 100 Hz of a unit that is tilted by `tilt` and errs by its biases.
void fill(StandStillFinder& finder, const Eigen::Vector3d& tilt, const Eigen::Vector3d& bias,
          double noise = 1e-3, double extra_force = 0) {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal(0, noise);
  const auto any = [&] {
    return Eigen::Vector3d{normal(generator), normal(generator), normal(generator)};
  };
  const Eigen::Vector3d up =
      geometry::exp_so3(tilt).transpose() * Eigen::Vector3d(0, 0, kGravity + extra_force);
  for (int k = 0; k < 200; ++k) {
    finder.add({geometry::Stamp::from_seconds(0.01 * k), "imu", bias + any(), up + any()});
  }
}

TEST(StandStill, FindsLevelAndBias) {
  StandStillFinder finder({}, kGravity);
  const Eigen::Vector3d bias(0.01, -0.02, 0.005);
  fill(finder, {0.1, -0.2, 0}, bias);
  const auto found = finder.find();
  ASSERT_TRUE(found.has_value());
  EXPECT_LT((found->gyro_bias - bias).norm(), 1e-3);
  // Roll and pitch bring the measured vertical to the z axis; a tilted unit does not tilt the map.
  const Eigen::Vector3d up =
      geometry::exp_so3(Eigen::Vector3d(0.1, -0.2, 0)).transpose() * Eigen::Vector3d::UnitZ();
  EXPECT_LT((found->R_level_body * up - Eigen::Vector3d::UnitZ()).norm(), 1e-3);
  EXPECT_NEAR(found->R_level_body(1, 0), 0, 1e-12);
}

TEST(StandStill, SeesTheAccelerometersBiasAlongGravity) {
  StandStillFinder finder({}, kGravity);
  fill(finder, {0, 0, 0}, {0, 0, 0}, 1e-3, 0.3);
  ASSERT_TRUE(finder.find().has_value());
  EXPECT_NEAR(finder.find()->accelerometer_bias.z(), 0.3, 1e-2);
}

TEST(StandStill, SaysWhyNot) {
  StandStillFinder none({}, kGravity);
  EXPECT_NE(none.why_not().find("0.00 s of IMU readings"), std::string::npos);
  StandStillFinder noisy({}, kGravity);
  fill(noisy, {0, 0, 0}, {0, 0, 0}, 0.1);
  EXPECT_NE(noisy.why_not().find("angular rate spreads"), std::string::npos);
  StandStillFinder turning({}, kGravity);
  fill(turning, {0, 0, 0}, {0, 0, 0.5});
  EXPECT_NE(turning.why_not().find("mean angular rate"), std::string::npos);
  StandStillFinder lifted({}, kGravity);
  fill(lifted, {0, 0, 0}, {0, 0, 0}, 1e-3, 2);
  EXPECT_NE(lifted.why_not().find("differs from gravity"), std::string::npos);
}

TEST(StandStill, WheelsThatTurnEitherWayAreMotion) {
  StandStillFinder finder({}, kGravity);
  fill(finder, {0, 0, 0}, {0, 0, 0});
  finder.add_wheels(geometry::Stamp::from_seconds(0.5), true);
  EXPECT_TRUE(finder.find().has_value());  // that was long ago
  finder.add_wheels(geometry::Stamp::from_seconds(1.5), true);
  EXPECT_FALSE(finder.find().has_value());
  EXPECT_NE(finder.why_not().find("wheels turned"), std::string::npos);
}

}  // namespace
}  // namespace traverse::inertial
