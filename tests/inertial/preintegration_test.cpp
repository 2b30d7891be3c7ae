#include "factors/preintegration.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "geometry/random_motion.hpp"
#include "residuals/inertial.hpp"

namespace traverse::inertial {
namespace {

using testing::RandomMotion;

/// Two hundredths of a second of readings a hundred times a second, as a lively vehicle gives.
Eigen::Vector3d rate(int k) {
  return {0.3 * std::sin(0.2 * k), 0.4 * std::cos(0.15 * k), 0.5 + 0.2 * std::sin(0.1 * k)};
}
Eigen::Vector3d force(int k) {
  return {1.5 * std::cos(0.1 * k), 0.8 * std::sin(0.2 * k), 9.8 + 0.5 * std::sin(0.3 * k)};
}

Preintegration integrated(const Eigen::Vector3d& bg, const Eigen::Vector3d& ba, int samples = 40) {
  Preintegration imu(ImuNoise{}, bg, ba);
  for (int k = 0; k < samples; ++k) imu.add(rate(k), force(k), 0.01);
  return imu;
}

TEST(Preintegration, OfAConstantTurnAndForceIsTheClosedForm) {
  // A turn about z at w with the force f along the body's x axis, piecewise constant in the body.
  Preintegration imu(ImuNoise{}, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  const double w = 0.5;
  const double f = 2;
  const double dt = 1e-4;
  for (int k = 0; k < 10000; ++k) imu.add({0, 0, w}, {f, 0, 0}, dt);
  EXPECT_NEAR(imu.seconds(), 1, 1e-9);
  const Eigen::Vector3d v(f * std::sin(w) / w, f * (1 - std::cos(w)) / w, 0);
  EXPECT_LT((imu.increments().velocity - v).norm(), 1e-4);
  EXPECT_NEAR(geometry::angle_of(imu.increments().rotation), w, 1e-9);
}

TEST(Preintegration, PredictsTheStateOfZeroResidual) {
  RandomMotion random(1);
  const Preintegration imu = integrated(random.vector(0.02), random.vector(0.1));
  NavState start;
  start.q_map_body = geometry::exp_quaternion(random.rotation_vector(2));
  start.p_map = random.vector(100);
  start.v_map = random.vector(10);
  start.gyro_bias = random.vector(0.05);
  start.accelerometer_bias = random.vector(0.2);
  const Eigen::Vector3d gravity(0, 0, -9.81);
  const NavState end = imu.predict(start, gravity);
  const InertialResidual motion{std::make_shared<Preintegration>(imu), gravity};
  EXPECT_LT(motion(start, end).norm(), 1e-12);
  EXPECT_DOUBLE_EQ(geometry::seconds_between(start.stamp, end.stamp), 0.4);
}

TEST(Preintegration, FirstOrderBiasCorrectionErrsWithTheSquareOfTheShift) {
  const Eigen::Vector3d direction = Eigen::Vector3d(1, -2, 0.5).normalized();
  const auto error = [&](double shift) {
    const Eigen::Vector3d bg = shift * direction;
    const auto exact = integrated(bg, Eigen::Vector3d::Zero()).increments();
    const auto corrected = integrated(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero())
                               .at(bg, Eigen::Vector3d::Zero());
    return geometry::angle_of(exact.rotation.transpose() * corrected.rotation);
  };
  EXPECT_LT(error(1.5e-3), 1e-8);
  EXPECT_LT(error(0.3), 1e-3);
  EXPECT_NEAR(error(0.2) / error(0.1), 4, 0.8);
}

TEST(Preintegration, ReintegratedIsAsIfIntegratedThere) {
  RandomMotion random(2);
  const Eigen::Vector3d bg = random.vector(0.1);
  const Eigen::Vector3d ba = random.vector(0.5);
  Preintegration moved = integrated(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  moved.reintegrate(bg, ba);
  const Preintegration there = integrated(bg, ba);
  EXPECT_EQ(moved.increments().position, there.increments().position);
  EXPECT_EQ(moved.covariance(), there.covariance());
  EXPECT_EQ(moved.seconds(), there.seconds());
  EXPECT_EQ(moved.samples(), there.samples());
}

TEST(Preintegration, NeedsTwoSamplesForAFullCovariance) {
  const Preintegration one = integrated({0, 0, 0}, {0, 0, 0}, 1);
  const Preintegration two = integrated({0, 0, 0}, {0, 0, 0}, 2);
  const auto rank = [](const Preintegration& imu) {
    return Eigen::FullPivLU<Preintegration::Matrix9>(imu.covariance()).rank();
  };
  EXPECT_FALSE(one.is_usable());
  EXPECT_EQ(rank(one), 6);
  EXPECT_TRUE(two.is_usable());
  EXPECT_EQ(rank(two), 9);
}

TEST(Preintegration, CovarianceIsThatOfNoisyRuns) {
  const ImuNoise noise{1e-2, 5e-2, 1e-9, 1e-9};
  const double dt = 0.01;
  const int samples = 20;
  const auto run = [&](const auto& perturb) {
    Preintegration imu(noise, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
    for (int k = 0; k < samples; ++k) {
      imu.add(perturb(rate(k), noise.gyro_density), perturb(force(k), noise.accelerometer_density),
              dt);
    }
    return imu;
  };
  const Preintegration exact = run([](const Eigen::Vector3d& x, double) { return x; });
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  const int runs = 4000;
  Preintegration::Matrix9 sum = Preintegration::Matrix9::Zero();
  for (int n = 0; n < runs; ++n) {
    const Preintegration noisy = run([&](const Eigen::Vector3d& x, double density) {
      const Eigen::Vector3d e{normal(generator), normal(generator), normal(generator)};
      return Eigen::Vector3d(x + density / std::sqrt(dt) * e);
    });
    Eigen::Matrix<double, 9, 1> d;
    d << geometry::log_so3(exact.increments().rotation.transpose() * noisy.increments().rotation),
        noisy.increments().velocity - exact.increments().velocity,
        noisy.increments().position - exact.increments().position;
    sum += d * d.transpose();
  }
  // In units of the predicted standard deviations, entries of the sample covariance spread by
  // sqrt(2 / runs) about their expectation; four times that is the bound.
  const Eigen::LLT<Preintegration::Matrix9> llt(exact.covariance());
  const Preintegration::Matrix9 half = llt.matrixL().solve(sum / runs);
  const Preintegration::Matrix9 whitened = llt.matrixL().solve(half.transpose());
  EXPECT_LT((whitened - Preintegration::Matrix9::Identity()).cwiseAbs().maxCoeff(),
            4 * std::sqrt(2.0 / runs));
}

TEST(Preintegration, CovarianceDoesNotDependOnTheRate) {
  const auto at = [](int samples) {
    Preintegration imu(ImuNoise{}, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
    for (int k = 0; k < samples; ++k) imu.add({0.1, 0.2, 0.3}, {1, 0, 9.8}, 0.5 / samples);
    return imu.covariance();
  };
  const auto slow = at(50);
  const auto fast = at(400);
  for (int k = 0; k < 9; ++k) EXPECT_NEAR(slow(k, k) / fast(k, k), 1, 0.02);
}

TEST(Preintegration, RefusesStretchesThatAreNoneAndNumbersThatAreNotFinite) {
  Preintegration imu(ImuNoise{}, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(imu.add(rate(0), force(0), 0), std::invalid_argument);
  EXPECT_THROW(imu.add(rate(0), force(0), -0.01), std::invalid_argument);
  EXPECT_THROW(imu.add(rate(0), force(0), nan), std::invalid_argument);
  EXPECT_THROW(imu.add(rate(0), force(0), infinity), std::invalid_argument);
  EXPECT_THROW(imu.add({nan, 0, 0}, force(0), 0.01), std::invalid_argument);
  EXPECT_THROW(imu.add(rate(0), {0, infinity, 0}, 0.01), std::invalid_argument);
  EXPECT_EQ(imu.samples(), 0U);
}

}  // namespace
}  // namespace traverse::inertial
