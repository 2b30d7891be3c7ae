#include "residuals.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "traverse/geometry/so3.hpp"

namespace traverse::pose_graph {
namespace {

using geometry::Pose3;

const Pose3 kI{geometry::exp_so3({0.3, -0.5, 1.2}), {4, -7, 2}};
const Pose3 kJ{geometry::exp_so3({-0.2, 0.4, 2.5}), {9, 1, -1}};

TEST(BetweenResidual, IsZeroForTheMotionItself) {
  EXPECT_LT(between_residual(kI.inverse() * kJ, kI, kJ).norm(), 1e-14);
}

TEST(BetweenResidual, IsTheErrorOfTheMeasurementInTheAxesItsCovarianceIsGivenIn) {
  const Pose3 T_i_j = kI.inverse() * kJ;
  const Eigen::Vector3d turned(0.02, -0.01, 0.03);
  const Eigen::Vector3d shifted(0.1, 0.2, -0.3);
  const Pose3 measured{T_i_j.rotation * geometry::exp_so3(turned), T_i_j.translation + shifted};
  const Residual<6> r = between_residual(measured, kI, kJ);
  EXPECT_LT((r.head<3>() + turned).norm(), 1e-14);
  EXPECT_LT((r.tail<3>() + shifted).norm(), 1e-14);
}

TEST(BetweenResidual, DoesNotKnowTheMapFrame) {
  const Pose3 measured{geometry::exp_so3({0.1, 0.2, 0.3}), {1, 2, 3}};
  const Pose3 T_other_map{geometry::exp_so3({1, 2, -0.5}), {100, -200, 30}};
  const Residual<6> here = between_residual(measured, kI, kJ);
  const Residual<6> there = between_residual(measured, T_other_map * kI, T_other_map * kJ);
  EXPECT_LT((here - there).norm(), 1e-12);
}

TEST(AntennaResidual, CarriesTheAntennaByTheLeverArm) {
  const Eigen::Vector3d lever(0.5, -0.2, 1.5);
  const Eigen::Vector3d measured = kI.rotation * lever + kI.translation - Eigen::Vector3d(1, 2, 3);
  EXPECT_LT((antenna_residual(measured, lever, kI) - Eigen::Vector3d(1, 2, 3)).norm(), 1e-14);
}

TEST(GravityResidual, HasTheSizeOfTheAngleAndDoesNotKnowTheHeading) {
  const double angle = 0.01;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d seen = kI.rotation.transpose() * geometry::exp_so3({angle, 0, 0}) * up;
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  EXPECT_NEAR(gravity_residual(seen, kI, up, none).norm(), angle, 1e-6);
  const Pose3 turned{geometry::exp_so3({0, 0, 0.7}) * kI.rotation, kI.translation};
  const Eigen::Vector3d level = kI.rotation.transpose() * up;
  EXPECT_LT(gravity_residual(level, turned, up, none).norm(), 1e-14);
  const Eigen::Vector3d offset(0.01, -0.02, 0.005);
  EXPECT_LT(gravity_residual(level + offset, turned, up, offset).norm(), 1e-14);
}

}  // namespace
}  // namespace traverse::pose_graph
