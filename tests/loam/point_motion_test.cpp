#include "point_motion.hpp"

#include <gtest/gtest.h>

#include "geometry/random_motion.hpp"

namespace traverse::loam {
namespace {

using optimization::Perturbation;
using testing::RandomMotion;

constexpr double kDifference = 1e-5;

TEST(PartOf, IsTheMotionItselfItsHalfAndNothing) {
  RandomMotion random(1);
  const geometry::Pose3 T = random.pose(3, 10);
  EXPECT_EQ(part_of(T, 1).matrix(), T.matrix());
  EXPECT_LT((part_of(T, 0).matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-15);
  const geometry::Pose3 half = part_of(T, 0.5);
  EXPECT_LT((half.rotation * half.rotation - T.rotation).norm(), 1e-14);
  EXPECT_LT((2 * half.translation - T.translation).norm(), 1e-14);
}

TEST(PointMotion, MovesThePointByItsPartOfTheMotion) {
  RandomMotion random(2);
  for (const double fraction : {0.0, 0.3, 1.0, 1.2}) {
    const geometry::Pose3 T = random.pose(2, 10);
    const Eigen::Vector3d p = random.vector(20);
    const auto moved =
        PointMotion(p, fraction, Perturbation::kRight).at(T.quaternion(), T.translation);
    EXPECT_LT((moved.q_map - part_of(T, fraction) * p).norm(), 1e-13);
  }
}

/// The point moved by the rotation disturbed on one side.
Eigen::Vector3d disturbed(const geometry::Pose3& T, const Eigen::Vector3d& p, double fraction,
                          Perturbation side, const Eigen::Vector3d& d) {
  const Eigen::Matrix3d E = geometry::exp_so3(d);
  const Eigen::Matrix3d R =
      side == Perturbation::kRight ? Eigen::Matrix3d(T.rotation * E) : E * T.rotation;
  return part_of({R, T.translation}, fraction) * p;
}

TEST(PointMotion, DerivativesMatchDifferencesOnBothSides) {
  RandomMotion random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const geometry::Pose3 T = random.pose(trial < 25 ? 3 : 1e-5, 10);
    const Eigen::Vector3d p = random.vector(20);
    for (const double fraction : {0.0, 0.3, 1.0, 1.2}) {
      for (const Perturbation side : {Perturbation::kRight, Perturbation::kLeft}) {
        const PointMotion motion(p, fraction, side);
        const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
        const Eigen::Matrix3d dq_dd =
            motion.by_rotation(identity, motion.at(T.quaternion(), T.translation));
        for (int k = 0; k < 3; ++k) {
          const Eigen::Vector3d d = kDifference * Eigen::Vector3d::Unit(k);
          const Eigen::Vector3d numeric =
              (disturbed(T, p, fraction, side, d) - disturbed(T, p, fraction, side, -d)) /
              (2 * kDifference);
          EXPECT_LT((dq_dd.col(k) - numeric).norm(), 1e-7) << fraction;
        }
        EXPECT_EQ(motion.by_translation(identity), fraction * identity);
      }
    }
  }
}

TEST(PointMotion, TwistsOfTheWholePoseMoveThePointAsInTheTable) {
  // T Exp(d, tau): dq = -R [p]x d + R tau.  Exp(d, tau) T: dq = -[q]x d + tau.
  RandomMotion random(5);
  const geometry::Pose3 T = random.pose(3, 10);
  const Eigen::Vector3d p = random.vector(20);
  Eigen::Matrix<double, 3, 6> body;
  body << -T.rotation * geometry::hat(p), T.rotation;
  Eigen::Matrix<double, 3, 6> map;
  map << -geometry::hat(T * p), Eigen::Matrix3d::Identity();
  for (int k = 0; k < 6; ++k) {
    const geometry::Pose3 step = geometry::exp_se3(kDifference * geometry::Twist::Unit(k));
    const geometry::Pose3 back = step.inverse();
    EXPECT_LT((body.col(k) - ((T * step) * p - (T * back) * p) / (2 * kDifference)).norm(), 1e-8);
    EXPECT_LT((map.col(k) - ((step * T) * p - (back * T) * p) / (2 * kDifference)).norm(), 1e-8);
  }
}

TEST(PointMotion, TheSidesDifferByTheRotation) {
  // dq/dd of the left times R is that of the right, since R Exp(d) = Exp(R d) R.
  RandomMotion random(4);
  const geometry::Pose3 T = random.pose(3, 10);
  const Eigen::Vector3d p = random.vector(20);
  for (const double fraction : {0.4, 1.0}) {
    const PointMotion right(p, fraction, Perturbation::kRight);
    const PointMotion left(p, fraction, Perturbation::kLeft);
    const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
    const auto moved = right.at(T.quaternion(), T.translation);
    const Eigen::Matrix3d by_left = left.by_rotation(identity, moved);
    EXPECT_LT((right.by_rotation(identity, moved) - by_left * T.rotation).norm(), 1e-12);
    EXPECT_GT((right.by_rotation(identity, moved) - by_left).norm(), 1);
  }
}

}  // namespace
}  // namespace traverse::loam
