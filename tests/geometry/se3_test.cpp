#include "traverse/geometry/se3.hpp"

#include <gtest/gtest.h>

namespace traverse::geometry {
namespace {

Twist twist(double rx, double ry, double rz, double tx, double ty, double tz) {
  return (Twist() << rx, ry, rz, tx, ty, tz).finished();
}

const Twist kMotion = twist(0.4, -1.1, 0.7, 3, -2, 5);
const Twist kOther = twist(-0.2, 0.3, 0.5, 1, 4, -2);

TEST(Se3, AdjointCarriesATwistToTheOtherSide) {
  const Pose3 pose = exp_se3(kMotion);
  const Pose3 right = pose * exp_se3(kOther);
  const Pose3 left = exp_se3(adjoint(pose) * kOther) * pose;
  EXPECT_LT((right.matrix() - left.matrix()).norm(), 1e-12);
}

TEST(Se3, SmallAdjointIsTheDerivativeOfTheAdjoint) {
  constexpr double h = 1e-6;
  const Twist numeric =
      (adjoint(exp_se3(h * kMotion)) - adjoint(exp_se3(-h * kMotion))) * kOther / (2 * h);
  EXPECT_LT((small_adjoint(kMotion) * kOther - numeric).norm(), 1e-7);
}

TEST(Se3, RightJacobianMatchesDifferences) {
  constexpr double h = 1e-6;
  const Pose3 back = exp_se3(kMotion).inverse();
  for (int k = 0; k < 6; ++k) {
    const Twist step = h * Twist::Unit(k);
    const Twist numeric =
        (log_se3(back * exp_se3(kMotion + step)) - log_se3(back * exp_se3(kMotion - step))) /
        (2 * h);
    EXPECT_LT((right_jacobian_se3(kMotion).col(k) - numeric).norm(), 1e-8) << k;
  }
}

TEST(Se3, RightJacobianOfNothingIsOne) {
  EXPECT_EQ(right_jacobian_se3(Twist::Zero()), Matrix6::Identity());
}

}  // namespace
}  // namespace traverse::geometry
