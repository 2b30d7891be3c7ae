#include "traverse/geometry/so3.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "geometry/random_motion.hpp"

namespace traverse::geometry {
namespace {

using testing::RandomMotion;

constexpr double kPi = std::numbers::pi;

TEST(So3, ExpIsARotationByTheVectorsLengthAboutItsDirection) {
  const Eigen::Matrix3d R = exp_so3({0, 0, kPi / 2});
  EXPECT_TRUE((R * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-15));
}

TEST(So3, LogInvertsExpFromTinyAnglesToNearPi) {
  RandomMotion random(1);
  for (const double angle : {0.0, 1e-12, 1e-8, 9.9e-5, 1.01e-4, 0.3, 3.0, kPi - 1e-9}) {
    const Eigen::Vector3d phi = random.vector(1).normalized() * angle;
    EXPECT_LT((log_so3(exp_so3(phi)) - phi).norm(), 1e-14 + 1e-12 * angle) << "angle " << angle;
  }
}

TEST(So3, LogTakesTheShortWayRound) {
  EXPECT_NEAR(log_so3(exp_so3({0, 0, 1.5 * kPi})).z(), -0.5 * kPi, 1e-14);
  EXPECT_NEAR(angle_of(exp_so3({0, 1.5 * kPi, 0})), 0.5 * kPi, 1e-14);
}

TEST(So3, RightJacobianPredictsASmallStepOnTheRight) {
  RandomMotion random(2);
  for (const double angle : {0.0, 1e-6, 9e-5, 0.01, 1.0, 3.0}) {
    const Eigen::Vector3d phi = random.vector(1).normalized() * angle;
    Eigen::Matrix3d numeric;
    const double step = 1e-6;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d d = step * Eigen::Vector3d::Unit(k);
      numeric.col(k) = (log_so3(exp_so3(phi).transpose() * exp_so3(phi + d)) -
                        log_so3(exp_so3(phi).transpose() * exp_so3(phi - d))) /
                       (2 * step);
    }
    EXPECT_LT((right_jacobian(phi) - numeric).norm(), 1e-9) << "angle " << angle;
  }
}

TEST(So3, InverseJacobiansInvertAlsoAtPi) {
  RandomMotion random(3);
  for (const double angle : {0.0, 5e-5, 2e-4, 1.0, 3.1, kPi}) {
    const Eigen::Vector3d phi = random.vector(1).normalized() * angle;
    EXPECT_LT(
        (right_jacobian(phi) * right_jacobian_inverse(phi) - Eigen::Matrix3d::Identity()).norm(),
        1e-11)
        << "angle " << angle;
    EXPECT_LT(
        (left_jacobian(phi) * left_jacobian_inverse(phi) - Eigen::Matrix3d::Identity()).norm(),
        1e-11)
        << "angle " << angle;
  }
}

TEST(So3, LeftJacobianIsTheRotatedRightOne) {
  RandomMotion random(4);
  const Eigen::Vector3d phi = random.rotation_vector(3);
  EXPECT_LT((left_jacobian(phi) - exp_so3(phi) * right_jacobian(phi)).norm(), 1e-14);
}

TEST(So3, SeriesAndClosedFormMeetAtTheThreshold) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, -1).normalized();
  const Eigen::Vector3d below = axis * 0.99999e-4;
  const Eigen::Vector3d above = axis * 1.00001e-4;
  EXPECT_LT((right_jacobian(below) - right_jacobian(above)).norm(), 2e-9);
  EXPECT_LT((right_jacobian_inverse(below) - right_jacobian_inverse(above)).norm(), 2e-9);
}

}  // namespace
}  // namespace traverse::geometry
