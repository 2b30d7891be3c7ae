#include "traverse/pipeline/clock_offset.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "traverse/geometry/so3.hpp"

namespace traverse::pipeline {
namespace {

using geometry::Stamp;

/// How fast a vehicle turns that takes corners now and then.
double yaw_rate(double seconds) {
  double rate = 0.02 * std::sin(0.9 * seconds);
  for (const double corner : {7.0, 19.0, 24.5, 41.0}) {
    rate += 0.5 * std::exp(-0.5 * std::pow((seconds - corner) / 1.1, 2));
  }
  return rate;
}

geometry::Trajectory poses_of(double from_s, double to_s, double step_s, double clock_s,
                              bool turns) {
  geometry::Trajectory path;
  double yaw = 0;
  double last = from_s;
  for (double t = from_s; t <= to_s; t += step_s) {
    for (; last + 0.005 < t; last += 0.005) yaw += turns ? 0.005 * yaw_rate(last) : 0;
    geometry::Pose3 pose;
    pose.rotation = geometry::exp_so3(Eigen::Vector3d(0, 0, yaw));
    path.push_back(Stamp::from_seconds(t + clock_s), pose);
  }
  return path;
}

std::vector<sensors::ImuSample> gyroscope() {
  std::vector<sensors::ImuSample> samples;
  for (int i = 0; i < 5000; ++i) {
    sensors::ImuSample sample;
    sample.stamp = Stamp::from_seconds(1'700'000'000 + 0.01 * i);
    sample.angular_rate = {0.001, -0.002, yaw_rate(0.01 * i)};
    samples.push_back(sample);
  }
  return samples;
}

TEST(ClockOffset, IsFoundToAFractionOfTheInterval) {
  const TurnedAngle turned = TurnedAngle::of(gyroscope());
  // Poses of a part of the drive, ten a second, by a clock that counts from somewhere else.
  const auto poses = poses_of(4, 46, 0.1, 321.0437, true);
  const auto offset = find_clock_offset(TurnedAngle::of(poses), turned);
  ASSERT_TRUE(offset);
  EXPECT_NEAR(offset->seconds, 1'700'000'000 - 321.0437, 0.02);
  EXPECT_GT(offset->correlation, 0.99);
  EXPECT_LT(offset->runner_up, 0.9);
}

TEST(ClockOffset, WhereNothingTurnsNothingIsTold) {
  const TurnedAngle turned = TurnedAngle::of(gyroscope());
  EXPECT_FALSE(find_clock_offset(TurnedAngle::of(poses_of(0, 40, 0.1, 0, false)), turned));
  EXPECT_FALSE(find_clock_offset(TurnedAngle::of(poses_of(0, 1, 0.1, 0, true)), turned));
}

TEST(ClockOffset, AWeaveThatFitsInManyPlacesTellsNothing) {
  const auto weave = [](double clock_s) {
    geometry::Trajectory path;
    for (int i = 0; i < 600; ++i) {
      geometry::Pose3 pose;
      pose.rotation = geometry::exp_so3(Eigen::Vector3d(0, 0, 0.3 * std::sin(0.1 * i)));
      path.push_back(Stamp::from_seconds(0.1 * i + clock_s), pose);
    }
    return TurnedAngle::of(path);
  };
  EXPECT_FALSE(find_clock_offset(weave(0), weave(3)));
}

}  // namespace
}  // namespace traverse::pipeline
