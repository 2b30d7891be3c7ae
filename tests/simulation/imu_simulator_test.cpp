#include "traverse/simulation/imu_simulator.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "traverse/geometry/so3.hpp"

#include "simulation/motion_settings.hpp"

namespace traverse::simulation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Position, velocity and attitude carried forward by readings alone.
struct Navigation {
  Matrix3d R;
  Vector3d p, v;
};

Navigation derivative(const Navigation& state, const sensors::ImuSample& reading) {
  return {state.R * geometry::hat(reading.angular_rate), state.v,
          state.R * reading.specific_force - Vector3d(0, 0, kGravity)};
}

Navigation plus(const Navigation& a, double h, const Navigation& b) {
  return {a.R + h * b.R, a.p + h * b.p, a.v + h * b.v};
}

/// Runge-Kutta of order 4.
Navigation advance(const Navigation& s, double h, const sensors::ImuSample& begin,
                   const sensors::ImuSample& middle, const sensors::ImuSample& end) {
  const Navigation k1 = derivative(s, begin);
  const Navigation k2 = derivative(plus(s, h / 2, k1), middle);
  const Navigation k3 = derivative(plus(s, h / 2, k2), middle);
  const Navigation k4 = derivative(plus(s, h, k3), end);
  Navigation result = plus(plus(plus(plus(s, h / 6, k1), h / 3, k2), h / 3, k3), h / 6, k4);
  result.R = geometry::Pose3{result.R, {}}.orthonormalised().rotation;
  return result;
}

TEST(ImuSimulator, IntegratedReadingsReturnThePath) {
  const VehicleMotion motion = testing::winding_drive();
  const ImuSettings settings;
  const ImuSimulator imu(settings, motion, 1);
  const auto truth = [&](double t) {
    return motion.state(t).at(settings.mounting.T_body_sensor());
  };
  constexpr double h = 0.0025;
  const MotionState start = truth(0);
  Navigation state{start.T_map_body.rotation, start.T_map_body.translation, start.velocity_map};
  double farthest = 0;
  double largest_angle = 0;
  const auto steps = static_cast<int>(motion.duration_s() / h);
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    state = advance(state, h, imu.exact(t), imu.exact(t + h / 2), imu.exact(t + h));
    const MotionState expected = truth(t + h);
    farthest = std::max(farthest, (state.p - expected.T_map_body.translation).norm());
    largest_angle = std::max(
        largest_angle, geometry::angle_of(expected.T_map_body.rotation.transpose() * state.R));
  }
  EXPECT_GT(
      (truth(motion.duration_s()).T_map_body.translation - start.T_map_body.translation).norm(),
      50);
  EXPECT_LT(farthest, 1e-6);
  EXPECT_LT(largest_angle, 1e-6);
}

TEST(ImuSimulator, AtRestItFeelsGravityUpwards) {
  const VehicleMotion motion({}, {}, Terrain({}, 1), 1);
  const sensors::ImuSample sample = ImuSimulator({}, motion, 1).exact(0.1);
  EXPECT_NEAR(sample.specific_force.z(), kGravity, 1e-9);
  EXPECT_LT(sample.angular_rate.norm(), 1e-9);
}

TEST(ImuSimulator, ErrorsHaveTheDeviationsAskedFor) {
  RouteSettings route;
  route.standstill_s = 60;
  const VehicleMotion motion(route, {}, Terrain({}, 1), 1);
  ImuSettings settings;
  settings.gyro_bias_walk = settings.accel_bias_walk = 0;
  ImuSimulator imu(settings, motion, 3);
  constexpr std::size_t kCount = 5000;
  Vector3d mean = Vector3d::Zero();
  double squares = 0;
  const Vector3d bias = imu.calibration().accel_bias;
  const Matrix3d& M = imu.calibration().accel_matrix;
  for (std::size_t i = 0; i < kCount; ++i) {
    const sensors::ImuSample sample = imu.sample(i);
    const Vector3d noise = sample.specific_force - M * Vector3d(0, 0, kGravity) - bias;
    mean += noise / kCount;
    squares += noise.squaredNorm() / (3 * kCount);
  }
  const double expected = settings.accel_noise * std::sqrt(settings.rate_hz);
  EXPECT_NEAR(std::sqrt(squares), expected, 0.03 * expected);
  EXPECT_LT(mean.norm(), 5 * expected / std::sqrt(double{kCount}));
  EXPECT_GT(bias.norm(), 1e-3);
  EXPECT_GT((M - Matrix3d::Identity()).norm(), 1e-4);
}

TEST(ImuSimulator, BiasesWalkAsFarAsTheirDensitySays) {
  const VehicleMotion motion({}, {}, Terrain({}, 1), 1);
  ImuSettings settings;
  settings.gyro_noise = settings.gyro_bias = settings.scale_error = settings.misalignment_deg = 0;
  settings.gyro_bias_walk = 1e-3;
  double squares = 0;
  constexpr int kRuns = 60;
  constexpr std::size_t kSamples = 100;  // one second
  for (int run = 0; run < kRuns; ++run) {
    ImuSimulator imu(settings, motion, static_cast<std::uint64_t>(run));
    for (std::size_t i = 0; i < kSamples; ++i) imu.sample(i);
    squares += imu.sample(kSamples).angular_rate.squaredNorm() / (3 * kRuns);
  }
  EXPECT_NEAR(std::sqrt(squares), 1e-3, 2e-4);
}

}  // namespace
}  // namespace traverse::simulation
