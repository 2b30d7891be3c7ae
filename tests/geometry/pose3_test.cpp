#include "traverse/geometry/pose3.hpp"

#include <gtest/gtest.h>

#include "geometry/random_motion.hpp"

namespace traverse::geometry {
namespace {

using testing::RandomMotion;

double distance(const Pose3& a, const Pose3& b) { return (a.matrix() - b.matrix()).norm(); }

TEST(Pose3, CompositionActsAsOneAfterTheOther) {
  RandomMotion random(1);
  const Pose3 T_a_b = random.pose(3, 10);
  const Pose3 T_b_c = random.pose(3, 10);
  const Eigen::Vector3d p_c = random.vector(10);
  EXPECT_LT(((T_a_b * T_b_c) * p_c - T_a_b * (T_b_c * p_c)).norm(), 1e-13);
}

TEST(Pose3, InverseUndoes) {
  RandomMotion random(2);
  const Pose3 T = random.pose(3, 10);
  EXPECT_LT(distance(T * T.inverse(), Pose3::identity()), 1e-14);
}

TEST(Pose3, QuaternionRoundTripKeepsTheRotation) {
  RandomMotion random(3);
  for (int i = 0; i < 100; ++i) {
    const Pose3 T = random.pose(3.14, 10);
    const Pose3 back = Pose3::from_quaternion(T.quaternion(), T.translation);
    EXPECT_LT(distance(T, back), 2e-15);
    EXPECT_GE(T.quaternion().w(), 0);
  }
}

TEST(Pose3, LogInvertsExp) {
  RandomMotion random(4);
  for (const double angle : {0.0, 1e-9, 5e-5, 0.5, 3.0}) {
    Twist twist;
    twist << random.vector(1).normalized() * angle, random.vector(5);
    EXPECT_LT((log_se3(exp_se3(twist)) - twist).norm(), 1e-12) << "angle " << angle;
  }
}

TEST(Pose3, InterpolationIsAScrewThroughBothEnds) {
  RandomMotion random(5);
  const Pose3 T0 = random.pose(1, 5);
  const Pose3 T1 = T0 * exp_se3((Twist() << 0, 0, 0.8, 2, 0, 0).finished());
  EXPECT_LT(distance(interpolate(T0, T1, 0), T0), 1e-14);
  EXPECT_LT(distance(interpolate(T0, T1, 1), T1), 1e-14);
  // Constant twist: both halves are the same motion.
  const Pose3 middle = interpolate(T0, T1, 0.5);
  EXPECT_LT(distance(T0.inverse() * middle, middle.inverse() * T1), 1e-14);
}

TEST(Pose3, OrthonormalisedRepairsARoundedMatrix) {
  Pose3 T;
  T.rotation << 0.9999, 0, 0, 0, 1.0001, 0, 0, 0, 1;
  const Pose3 repaired = T.orthonormalised();
  EXPECT_LT(
      (repaired.rotation * repaired.rotation.transpose() - Eigen::Matrix3d::Identity()).norm(),
      1e-15);
}

}  // namespace
}  // namespace traverse::geometry
