#include "inertial_start.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "fusion/simulated_imu.hpp"

namespace traverse::fusion {
namespace {

using testing::simulated_imu;

const Eigen::Vector3d kStartArm(-0.4, 0.1, -1.4);
const Eigen::Vector3d kStartGyroBias(0.01, -0.02, 0.005);

geometry::Pose3 standing(double) {
  geometry::Pose3 pose;
  pose.rotation = geometry::exp_so3({0.3, -0.2, 0});  // on a slope
  return pose;
}

geometry::Pose3 walking(double t) {
  geometry::Pose3 pose;
  pose.rotation =
      geometry::exp_so3({0, 0, 0.5 * std::sin(1.5 * t)}) * geometry::exp_so3({0.3, 0.1, 0});
  pose.translation = {3 * t, 0.4 * std::sin(2 * t), 0.1 * std::sin(3 * t)};
  return pose;
}

/// What the lidar alone finds: its poses from the first.
template <typename Pose>
std::vector<Sighting> sightings(const Pose& pose, double seconds) {
  std::vector<Sighting> result;
  for (double t = 0; t < seconds + 0.01; t += 0.1) {
    result.push_back({geometry::Stamp::from_seconds(t), pose(0).inverse() * pose(t)});
  }
  return result;
}

ImuReadings readings_of(std::vector<sensors::ImuSample> samples, double force_unit = 1) {
  ImuReadings imu;
  for (sensors::ImuSample& sample : samples) {
    sample.specific_force *= force_unit;
    imu.add(sample);
  }
  return imu;
}

template <typename Pose>
std::vector<sensors::ImuSample> samples_of(const Pose& pose, double seconds) {
  return simulated_imu(pose, kStartArm, 0, seconds, kStartGyroBias,
                       Eigen::Vector3d(0.02, -0.01, 0.03));
}

TEST(FindStart, StandingStillGravityIsTheMeanForce) {
  const StartVerdict verdict =
      find_start(sightings(standing, 1), readings_of(samples_of(standing, 1)), kStartArm,
                 InertialOdometryOptions());
  ASSERT_TRUE(verdict.first) << verdict.why_not;
  const Eigen::Vector3d down = standing(0).rotation.transpose() * Eigen::Vector3d(0, 0, -1);
  EXPECT_LT((verdict.first->gravity_map.normalized() - down).norm(), 0.005);  // of the bias
  EXPECT_LT((verdict.first->state.gyro_bias - kStartGyroBias).norm(), 1e-6);
  EXPECT_TRUE(verdict.first->state.v_map.isZero(0));
  EXPECT_LT((verdict.first->state.p_map - kStartArm).norm(), 1e-9);
}

TEST(FindStart, InMotionGravityAndVelocityFollowFromTheWay) {
  const StartVerdict verdict =
      find_start(sightings(walking, 2.1), readings_of(samples_of(walking, 2.1)), kStartArm,
                 InertialOdometryOptions());
  ASSERT_TRUE(verdict.first) << verdict.why_not;
  const geometry::Pose3 T_map_world = walking(0).inverse();
  const Eigen::Vector3d down = T_map_world.rotation * Eigen::Vector3d(0, 0, -1);
  EXPECT_LT((verdict.first->gravity_map.normalized() - down).norm(), 0.01);
  EXPECT_LT((verdict.first->state.gyro_bias - kStartGyroBias).norm(), 1e-3);
  constexpr double h = 1e-4;
  const Eigen::Vector3d v =
      T_map_world.rotation *
      ((walking(2.1 + h) * kStartArm - walking(2.1 - h) * kStartArm) / (2 * h));
  EXPECT_LT((verdict.first->state.v_map - v).norm(), 0.05);
}

TEST(FindStart, WaitsUntilItKnowsEnough) {
  const auto options = InertialOdometryOptions();
  const ImuReadings imu = readings_of(samples_of(walking, 2.1));
  EXPECT_NE(find_start(sightings(walking, 0.5), imu, kStartArm, options).why_not.find("are needed"),
            std::string::npos);
  EXPECT_NE(find_start(sightings(walking, 1.5), imu, kStartArm, options).why_not.find("in motion"),
            std::string::npos);
}

TEST(FindStart, AnImuInGIsNotBelieved) {
  const StartVerdict verdict =
      find_start(sightings(walking, 2.1), readings_of(samples_of(walking, 2.1), 1 / 9.80665),
                 kStartArm, InertialOdometryOptions());
  EXPECT_FALSE(verdict.first);
  EXPECT_NE(verdict.why_not.find("gravity by the IMU"), std::string::npos) << verdict.why_not;
}

TEST(FindStart, AxesThatAreNotTheLidarsAreNotBelieved) {
  std::vector<sensors::ImuSample> samples = samples_of(walking, 2.1);
  for (sensors::ImuSample& sample : samples) {
    const auto turned = [](const Eigen::Vector3d& v) {
      return Eigen::Vector3d(v.x(), v.z(), -v.y());
    };
    sample.angular_rate = turned(sample.angular_rate);
    sample.specific_force = turned(sample.specific_force);
  }
  const StartVerdict verdict = find_start(sightings(walking, 2.1), readings_of(samples), kStartArm,
                                          InertialOdometryOptions());
  EXPECT_FALSE(verdict.first);
  EXPECT_NE(verdict.why_not.find("does not turn as the lidar"), std::string::npos)
      << verdict.why_not;
}

TEST(ImuReadingsOfTests, AreGivenWithOneAtEitherEnd) {
  ImuReadings imu = readings_of(samples_of(walking, 1));
  const auto from = geometry::Stamp::from_seconds(0.205);
  const auto to = geometry::Stamp::from_seconds(0.303);
  const auto between = imu.between(from, to);
  ASSERT_EQ(between.size(), 12U);
  EXPECT_EQ(between.front().stamp, from);
  EXPECT_EQ(between.back().stamp, to);
  EXPECT_NEAR(imu.longest_gap_s(from, to), 0.01, 1e-9);
  EXPECT_NEAR(imu.longest_gap_s(from, geometry::Stamp::from_seconds(1.5)), 0.5, 1e-9);
  imu.forget_before(from);
  EXPECT_EQ(imu.between(from, to).size(), 12U);
  sensors::ImuSample bad = between.back();
  imu.add(bad);  // not later than the last
  bad.stamp = geometry::Stamp::from_seconds(9);
  bad.angular_rate.x() = NAN;
  imu.add(bad);
  EXPECT_EQ(imu.left_out(), 2U);
}

}  // namespace
}  // namespace traverse::fusion
