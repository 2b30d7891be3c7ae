#include "traverse/slam/odometry_chain.hpp"

#include <random>

#include <gtest/gtest.h>

#include "traverse/geometry/so3.hpp"

namespace traverse::slam {
namespace {

constexpr double kTurn = 0.004;  // rad, of a step
constexpr double kShift = 0.02;  // m

geometry::Pose3 step(std::size_t k) {
  geometry::Pose3 T;
  T.rotation = geometry::exp_so3({0.01, 0.02, k % 10 < 5 ? 0.15 : -0.05});
  T.translation = {2, 0.1, 0.02};
  return T;
}

geometry::Matrix6 step_covariance() {
  geometry::Matrix6 covariance = geometry::Matrix6::Zero();
  covariance.diagonal() << kTurn * kTurn, kTurn * kTurn, 4 * kTurn * kTurn, 4 * kShift * kShift,
      kShift * kShift, kShift * kShift;
  return covariance;
}

/// The covariance of the whole way is that of many simulated drives with noisy steps.
TEST(OdometryChain, CovarianceIsThatOfSimulatedDrives) {
  constexpr std::size_t kSteps = 20;
  constexpr int kDrives = 2000;
  OdometryChain chain;
  geometry::Pose3 T;
  chain.add(T, geometry::Matrix6::Zero());
  for (std::size_t k = 0; k < kSteps; ++k) chain.add(T = T * step(k), step_covariance());

  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  geometry::Matrix6 sum = geometry::Matrix6::Zero();
  for (int drive = 0; drive < kDrives; ++drive) {
    geometry::Pose3 noisy;
    for (std::size_t k = 5; k < kSteps; ++k) {
      geometry::Pose3 s = step(k);
      const geometry::Twist sigma = step_covariance().diagonal().cwiseSqrt();
      geometry::Twist e;
      for (int i = 0; i < 6; ++i) e[i] = sigma[i] * normal(generator);
      s.rotation = s.rotation * geometry::exp_so3(e.head<3>());
      s.translation += e.tail<3>();
      noisy = noisy * s;
    }
    const geometry::Twist off = geometry::log_se3(chain.motion(5, kSteps).inverse() * noisy);
    sum += off * off.transpose() / kDrives;
  }
  const geometry::Matrix6 predicted = chain.covariance(5, kSteps);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(sum(i, i) / predicted(i, i), 1, 0.12) << "axis " << i;
    for (int j = 0; j < i; ++j) {
      const double scale = std::sqrt(predicted(i, i) * predicted(j, j));
      EXPECT_NEAR(sum(i, j) / scale, predicted(i, j) / scale, 0.12) << i << ", " << j;
    }
  }
}

TEST(OdometryChain, MotionAndWay) {
  OdometryChain chain;
  geometry::Pose3 T;
  chain.add(T, geometry::Matrix6::Zero());
  for (std::size_t k = 0; k < 3; ++k) chain.add(T = T * step(k), step_covariance());
  EXPECT_NEAR(chain.way_m(1, 3), 2 * step(0).translation.norm(), 1e-12);
  const geometry::Pose3 there_and_back = chain.motion(1, 3) * chain.motion(3, 1);
  EXPECT_LT(geometry::log_se3(there_and_back).norm(), 1e-12);
  EXPECT_TRUE(chain.covariance(2, 2).isZero());
}

}  // namespace
}  // namespace traverse::slam
