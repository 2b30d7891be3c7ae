#include "rotation_manifold.hpp"

#include <ceres/manifold_test_utils.h>
#include <gtest/gtest.h>

#include "geometry/random_motion.hpp"

namespace traverse::lidar {
namespace {

using testing::RandomMotion;

Eigen::Quaterniond random_quaternion(RandomMotion& random) {
  return geometry::exp_quaternion(random.rotation_vector(3)).normalized();
}

TEST(RotationManifold, HoldsCeresInvariants) {
  using namespace ceres;  // the macro below names its matchers without their namespace
  RandomMotion random(1);
  const RotationManifold manifold;
  for (int trial = 0; trial < 30; ++trial) {
    const Eigen::VectorXd x = random_quaternion(random).coeffs();
    const Eigen::VectorXd y = random_quaternion(random).coeffs();
    for (const double angle : {0.0, 1e-7, 1e-3, 1.0, 3.0}) {
      const Eigen::VectorXd delta = random.vector(1).normalized() * angle;
      EXPECT_THAT_MANIFOLD_INVARIANTS_HOLD(manifold, x, delta, y, 1e-8);
    }
  }
}

TEST(RotationManifold, PlusTurnsByTheFullAngleOnTheRight) {
  RandomMotion random(2);
  const Eigen::Quaterniond q = random_quaternion(random);
  const Eigen::Vector3d delta = random.rotation_vector(2);
  Eigen::Quaterniond moved;
  RotationManifold().Plus(q.coeffs().data(), delta.data(), moved.coeffs().data());
  EXPECT_LT((moved.toRotationMatrix() - q.toRotationMatrix() * geometry::exp_so3(delta)).norm(),
            1e-14);
}

TEST(RotationManifold, PlusJacobianTransposedTimesItselfIsAQuarter) {
  RandomMotion random(3);
  const Eigen::Quaterniond q = random_quaternion(random);
  const auto P = RotationManifold::plus_jacobian(q.coeffs().data());
  EXPECT_LT((P.transpose() * P - 0.25 * Eigen::Matrix3d::Identity()).norm(), 1e-15);
}

}  // namespace
}  // namespace traverse::lidar
