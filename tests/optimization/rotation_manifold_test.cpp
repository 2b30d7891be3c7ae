#include "traverse/optimization/rotation_manifold.hpp"

#include <ceres/manifold_test_utils.h>
#include <gtest/gtest.h>

#include "geometry/random_motion.hpp"

namespace traverse::optimization {
namespace {

using testing::RandomMotion;

constexpr Perturbation kBothSides[] = {Perturbation::kRight, Perturbation::kLeft};

Eigen::Quaterniond random_quaternion(RandomMotion& random) {
  return geometry::exp_quaternion(random.rotation_vector(3)).normalized();
}

TEST(RotationManifold, HoldsCeresInvariants) {
  using namespace ceres;  // the macro below names its matchers without their namespace
  RandomMotion random(1);
  for (const Perturbation side : kBothSides) {
    const RotationManifold manifold(side);
    for (int trial = 0; trial < 30; ++trial) {
      const Eigen::VectorXd x = random_quaternion(random).coeffs();
      const Eigen::VectorXd y = random_quaternion(random).coeffs();
      for (const double angle : {0.0, 1e-7, 1e-3, 1.0, 3.0}) {
        const Eigen::VectorXd delta = random.vector(1).normalized() * angle;
        EXPECT_THAT_MANIFOLD_INVARIANTS_HOLD(manifold, x, delta, y, 1e-8);
      }
    }
  }
}

TEST(RotationManifold, PlusTurnsByTheFullAngleOnItsSide) {
  RandomMotion random(2);
  const Eigen::Quaterniond q = random_quaternion(random);
  const Eigen::Vector3d delta = random.rotation_vector(2);
  const Eigen::Matrix3d R = q.toRotationMatrix();
  const Eigen::Matrix3d E = geometry::exp_so3(delta);
  Eigen::Quaterniond moved;
  RotationManifold().Plus(q.coeffs().data(), delta.data(), moved.coeffs().data());
  EXPECT_LT((moved.toRotationMatrix() - R * E).norm(), 1e-14);
  RotationManifold(Perturbation::kLeft)
      .Plus(q.coeffs().data(), delta.data(), moved.coeffs().data());
  EXPECT_LT((moved.toRotationMatrix() - E * R).norm(), 1e-14);
}

TEST(RotationManifold, PlusJacobianTransposedTimesItselfIsAQuarter) {
  RandomMotion random(3);
  const Eigen::Quaterniond q = random_quaternion(random);
  for (const Perturbation side : kBothSides) {
    const auto P = RotationManifold::plus_jacobian(q.coeffs().data(), side);
    EXPECT_LT((P.transpose() * P - 0.25 * Eigen::Matrix3d::Identity()).norm(), 1e-15);
  }
}

TEST(RotationManifold, TheAmbientDerivativeKnowsNoSide) {
  // Exp(d) R = R Exp(R' d): a tangent Jacobian J of the right is J R' on the left.
  RandomMotion random(4);
  const Eigen::Quaterniond q = random_quaternion(random);
  const double* coefficients = q.coeffs().data();
  const auto right = RotationManifold::plus_jacobian(coefficients, Perturbation::kRight);
  const auto left = RotationManifold::plus_jacobian(coefficients, Perturbation::kLeft);
  const Eigen::RowVector3d J_right = random.vector(1).transpose();
  const Eigen::RowVector3d J_left = J_right * q.toRotationMatrix().transpose();
  EXPECT_LT((J_right * right.transpose() - J_left * left.transpose()).norm(), 1e-15);
}

}  // namespace
}  // namespace traverse::optimization
