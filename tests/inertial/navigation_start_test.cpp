#include "navigation/navigation_start.hpp"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/geometry/so3.hpp"

#include "inertial/moment.hpp"

namespace traverse::inertial {
namespace {

using ::testing::HasSubstr;
using testing::moment;

constexpr double kDownwards = 9.81;
const Eigen::Vector3d kAntenna(0.5, 0.2, 1);
const Eigen::Vector3d kGyroBias(0.003, -0.002, 0.001);

Mounts antenna_mounts() {
  Mounts mounts;
  mounts.antenna_body = kAntenna;
  return mounts;
}

NavigationStart navigation_start(const NavigationOptions& options = {}) {
  return {options, antenna_mounts(), kDownwards};
}

/// Readings at 100 Hz of an IMU that is tilted by roll and pitch and stands or, shaken, drives.
void feed_imu(NavigationStart& start, double from_s, double to_s, bool is_shaken,
              const Eigen::Vector3d& tilt = Eigen::Vector3d::Zero()) {
  const Eigen::Vector3d up =
      geometry::exp_so3(tilt).transpose() * Eigen::Vector3d(0, 0, kDownwards);
  for (int k = static_cast<int>(std::lround(100 * from_s)); k < 100 * to_s; ++k) {
    const double shake = is_shaken ? (k % 2 == 0 ? 1 : -1) : 0;
    start.add({moment(0.01 * k), "imu", kGyroBias, up + Eigen::Vector3d(shake, 0, 0)});
  }
}

MapFix map_fix(double seconds, double east_m, double north_m) {
  MapFix result;
  result.stamp = moment(seconds);
  result.p_antenna_map = {east_m, north_m, 0};
  result.covariance = 0.01 * Eigen::Matrix3d::Identity();
  result.heading_sigma = 0.005;
  return result;
}

double yaw_of(const NavState& state) {
  const Eigen::Matrix3d R = state.rotation();
  return std::atan2(R(1, 0), R(0, 0));
}

TEST(NavigationStart, StandingStillTwoAntennasTellTheHeading) {
  NavigationStart begin = navigation_start();
  feed_imu(begin, 0, 2, false, {0.03, -0.05, 0});
  MapFix with_heading = map_fix(1.9, 10, 20);
  with_heading.heading = 0.7;
  EXPECT_FALSE(begin.at_fix(with_heading).has_value()) << "one alone";
  with_heading.stamp = moment(2);
  const auto first = begin.at_fix(with_heading);
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->state.stamp, moment(2));
  EXPECT_NEAR(yaw_of(first->state), 0.7, 1e-9);
  EXPECT_LT((first->state.gyro_bias - kGyroBias).norm(), 1e-9);
  EXPECT_EQ(first->state.v_map.norm(), 0);
  const Eigen::Vector3d up_body = first->state.rotation().transpose() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d true_up =
      geometry::exp_so3(Eigen::Vector3d(0.03, -0.05, 0)).transpose() * Eigen::Vector3d::UnitZ();
  EXPECT_LT((up_body - true_up).norm(), 1e-9);
  const Eigen::Vector3d antenna = first->state.T_map_body() * kAntenna;
  EXPECT_LT((antenna - with_heading.p_antenna_map).norm(), 1e-9) << "the lever arm";
  EXPECT_THAT(first->note, HasSubstr("from a stand-still"));
  EXPECT_THAT(first->note, HasSubstr("heading from two antennas"));
}

TEST(NavigationStart, InMotionTwoFixesFarEnoughApartTellHeadingAndSpeed) {
  for (const double course : {0.0, 1.0, -2.0, 3.0}) {  // rad from east, counterclockwise
    NavigationStart begin = navigation_start();
    feed_imu(begin, -1, 0.5, true);
    const auto at_metres = [&](double seconds, double metres) {
      return map_fix(seconds, metres * std::cos(course), metres * std::sin(course));
    };
    EXPECT_FALSE(begin.at_fix(at_metres(0.1, 0)).has_value());
    EXPECT_FALSE(begin.at_fix(at_metres(0.3, 1)).has_value())
        << "1 m of fixes to 0.1 m is a course to 8 degrees";
    const auto first = begin.at_fix(at_metres(0.5, 4));
    ASSERT_TRUE(first.has_value());
    EXPECT_NEAR(std::remainder(yaw_of(first->state) - course, 2 * std::numbers::pi), 0, 1e-3);
    EXPECT_NEAR(first->state.v_map.norm(), 10, 1e-9) << "4 m in 0.4 s";
    EXPECT_EQ(first->state.gyro_bias.norm(), 0) << "which only a stand-still tells";
    EXPECT_GT(first->sigma[NavState::kGyroBias], 0.01);
    EXPECT_THAT(first->note, HasSubstr("heading from 4.0 m between fixes"));
    EXPECT_THAT(first->note, HasSubstr("no stand-still"));
  }
}

TEST(NavigationStart, WheelsThatTurnBackwardsTurnTheHeadingRound) {
  NavigationStart begin = navigation_start();
  feed_imu(begin, -1, 0.5, true);
  begin.add_wheels(moment(0.4), -10);
  begin.at_fix(map_fix(0.1, 0, 0));
  const auto first = begin.at_fix(map_fix(0.5, 4, 0));
  ASSERT_TRUE(first.has_value());
  EXPECT_NEAR(std::abs(yaw_of(first->state)), std::numbers::pi, 1e-3);
  EXPECT_NEAR(first->state.v_map.x(), 10, 1e-9) << "it moves east, tail first";
}

TEST(NavigationStart, ACourseIsTakenAtTheSpeedAtWhichItIsExactEnough) {
  for (const double speed : {0.3, 0.6, 1.3}) {
    for (const double sigma : {0.01, 0.1}) {
      NavigationStart begin = navigation_start();
      feed_imu(begin, -1, 0.05, true);
      double started = 0;
      for (int k = 0; k < 100 && started == 0; ++k) {
        feed_imu(begin, 0.05 + 0.1 * k, 0.15 + 0.1 * k, true);
        MapFix fix = map_fix(0.1 + 0.1 * k, 0.1 * k * speed, 0);
        fix.covariance = sigma * sigma * Eigen::Matrix3d::Identity();
        if (begin.at_fix(fix).has_value()) started = 0.1 * k;
      }
      // sqrt(2) sigma and a step that does not show, over the way, are 5 degrees, within course_s;
      // the gyro's bias is the rest.
      const double unseen = std::min(3 * sigma, 0.19);
      const double way = std::hypot(std::numbers::sqrt2 * sigma, unseen) / 0.087;
      if (way > 4.9 * speed) {
        EXPECT_EQ(started, 0) << speed << ", " << sigma;
      } else {
        EXPECT_NEAR(started, way / speed, 0.15 + 0.2 * way / speed) << speed << ", " << sigma;
      }
    }
  }
}

TEST(NavigationStart, AStepOfTheReceiverIsNoCourse) {
  for (const double at_s : {0.5, 1.0, 2.5}) {  // while it creeps along the x axis
    NavigationStart begin = navigation_start();
    feed_imu(begin, -1, 0.05, true);
    std::optional<FirstState> first;
    for (int k = 0; k < 100 && !first; ++k) {
      const double t = 0.1 * k;
      feed_imu(begin, 0.05 + t, 0.15 + t, true);
      const double noise = 0.01 * (k % 3 - 1);
      MapFix fix = map_fix(0.1 + t, 0.04 * t * t + noise, (t < at_s ? 0.0 : 0.15) - noise);
      fix.covariance = 1e-4 * Eigen::Matrix3d::Identity();
      first = begin.at_fix(fix);
    }
    ASSERT_TRUE(first.has_value()) << at_s;
    EXPECT_NEAR(yaw_of(first->state), 0, 0.2) << at_s;
  }
}

TEST(NavigationStart, FixesOfUnknownDeviationMustBeFarApart) {
  NavigationStart begin = navigation_start();
  feed_imu(begin, 0, 10, true);
  for (int second = 0; second < 10; ++second) {
    MapFix fix = map_fix(second, 0.5 * second, 0);
    fix.is_sigma_known = false;
    EXPECT_FALSE(begin.at_fix(fix).has_value()) << "2.5 m in course_s";
  }
  EXPECT_THAT(begin.why_not(), HasSubstr("nor did they move 3 m, within 5 s"));
}

TEST(NavigationStart, InATurnTheCourseIsThatOfTheRearAxle) {
  Mounts mounts;
  mounts.antenna_body = {1.5, 0.5, 0};
  for (const double rate : {-0.2, 0.1, 0.2}) {
    NavigationStart begin({}, mounts, kDownwards);
    constexpr double kSpeed = 2;
    const auto antenna = [&](double t) {
      const double yaw = 0.5 + rate * t;
      const Eigen::Vector2d axle =
          kSpeed / rate *
          Eigen::Vector2d(std::sin(yaw) - std::sin(0.5), std::cos(0.5) - std::cos(yaw));
      return Eigen::Vector2d(axle + Eigen::Rotation2Dd(yaw) *
                                        Eigen::Vector2d(mounts.antenna_body.head<2>()));
    };
    std::optional<FirstState> first;
    double t = 0;
    for (int k = -100; k < 200 && !first; ++k) {
      t = 0.01 * k;
      begin.add({moment(t), "imu", {0, 0, rate}, {k % 2 == 0 ? 1.0 : -1.0, 0, kDownwards}});
      if (k < 0 || k % 10 != 0) continue;
      MapFix fix = map_fix(t, antenna(t).x(), antenna(t).y());
      fix.covariance = 1e-4 * Eigen::Matrix3d::Identity();
      first = begin.at_fix(fix);
    }
    ASSERT_TRUE(first.has_value()) << rate;
    EXPECT_NEAR(yaw_of(first->state), 0.5 + rate * t, 2e-3)
        << "the antenna's own course is off by up to " << rate * 1.5 / kSpeed;
  }
}

TEST(NavigationStart, OneHeadingAloneIsNotBelieved) {
  NavigationStart begin = navigation_start();
  feed_imu(begin, 0, 2, false);
  const auto with_heading = [](double seconds, double heading) {
    MapFix fix = map_fix(seconds, 0, 0);
    fix.heading = heading;
    return fix;
  };
  EXPECT_FALSE(begin.at_fix(with_heading(1.7, 2.5)).has_value());
  EXPECT_FALSE(begin.at_fix(with_heading(1.8, 0.7)).has_value()) << "which of the two?";
  const auto first = begin.at_fix(with_heading(1.9, 0.702));
  ASSERT_TRUE(first.has_value());
  EXPECT_NEAR(yaw_of(first->state), 0.702, 1e-9);
}

TEST(NavigationStart, AStandStillIsRememberedWhenTheDriveBegins) {
  NavigationStart begin = navigation_start();
  feed_imu(begin, 0, 2, false);
  feed_imu(begin, 2, 3, true);
  begin.at_fix(map_fix(2.6, 0, 0));
  const auto first = begin.at_fix(map_fix(3, 4, 0));
  ASSERT_TRUE(first.has_value());
  EXPECT_LT((first->state.gyro_bias - kGyroBias).norm(), 1e-9);
  EXPECT_LT(first->sigma[NavState::kGyroBias], 1e-3);
  EXPECT_NEAR(first->state.v_map.x(), 10, 1e-9);
}

TEST(NavigationStart, WithoutFixesAStandStillBeginsAPathOfItsOwn) {
  NavigationOptions options;
  options.start.gnss_wait_s = 3;
  NavigationStart begin = navigation_start(options);
  EXPECT_FALSE(begin.without_fix(moment(0)).has_value());
  EXPECT_EQ(begin.why_not(), "no IMU reading came");
  feed_imu(begin, 0, 2.5, false);
  EXPECT_FALSE(begin.without_fix(moment(2.5)).has_value()) << "a fix may come yet";
  feed_imu(begin, 2.5, 3.5, false);
  const auto first = begin.without_fix(moment(3.5));
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->state.p_map.norm(), 0);
  EXPECT_NEAR(yaw_of(first->state), 0, 1e-9) << "its heading is its own";
  EXPECT_LT(first->sigma[NavState::kRotation + 2], 0.01);
  EXPECT_THAT(first->note, HasSubstr("dead reckoning in a frame of its own"));
}

TEST(NavigationStart, WithoutFixesAndStandStillThereIsNoStart) {
  NavigationOptions options;
  options.start.gnss_wait_s = 1;
  NavigationStart shaken = navigation_start(options);
  feed_imu(shaken, 0, 5, true);
  EXPECT_FALSE(shaken.without_fix(moment(5)).has_value());
  EXPECT_THAT(shaken.why_not(), HasSubstr("no fix came"));
  EXPECT_THAT(shaken.why_not(), HasSubstr("specific force spreads by"));

  NavigationStart rolling = navigation_start(options);
  rolling.add_wheels(moment(4.9), 0.5);
  feed_imu(rolling, 0, 5, false);
  EXPECT_FALSE(rolling.without_fix(moment(5)).has_value());
  EXPECT_THAT(rolling.why_not(), HasSubstr("the wheels turned"));

  NavigationStart with_fix = navigation_start(options);
  feed_imu(with_fix, 0, 5, false);
  with_fix.at_fix(map_fix(4, 0, 0));
  EXPECT_FALSE(with_fix.without_fix(moment(5)).has_value())
      << "where there are fixes, one must begin";
  EXPECT_THAT(with_fix.why_not(), HasSubstr("no heading"));
}

}  // namespace
}  // namespace traverse::inertial
