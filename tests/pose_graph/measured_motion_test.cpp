#include "measured_motion.hpp"

#include <gtest/gtest.h>

#include "traverse/geometry/so3.hpp"

namespace traverse::pose_graph {
namespace {

using geometry::Matrix6;
using geometry::Pose3;
using geometry::Twist;

const Pose3 kFirst{geometry::exp_so3({0.3, -0.5, 1.9}), {4, -7, 2}};
const Pose3 kSecond{geometry::exp_so3({-0.8, 0.4, -0.6}), {-3, 9, 1}};
constexpr double kSmall = 1e-6;

/// In the convention of PoseGraph::add_between.
Pose3 disturbed(const Pose3& T, const Twist& error) {
  return {T.rotation * geometry::exp_so3(error.head<3>()), T.translation + error.tail<3>()};
}
Twist error_of(const Pose3& measured, const Pose3& truth) {
  Twist error;
  error << geometry::log_so3(truth.rotation.transpose() * measured.rotation),
      measured.translation - truth.translation;
  return error;
}

/// An error along one axis, and the covariance of one that has no other direction.
Twist error_along(int axis) { return kSmall * Twist::Unit(axis); }
Matrix6 covariance_along(int axis) { return error_along(axis) * error_along(axis).transpose(); }

void expect_covariance_of(const Twist& error, const Matrix6& covariance) {
  const Matrix6 expected = error * error.transpose();
  EXPECT_LT((covariance - expected).norm(), 1e-5 * expected.norm()) << error.transpose();
}

TEST(MeasuredMotion, TheErrorOfAProductIsThatOfItsParts) {
  for (int axis = 0; axis < 6; ++axis) {
    const Twist error = error_along(axis);
    const MeasuredMotion by_first =
        MeasuredMotion{kFirst, covariance_along(axis)} * MeasuredMotion{kSecond, Matrix6::Zero()};
    expect_covariance_of(error_of(disturbed(kFirst, error) * kSecond, kFirst * kSecond),
                         by_first.covariance);
    const MeasuredMotion by_second =
        MeasuredMotion{kFirst, Matrix6::Zero()} * MeasuredMotion{kSecond, covariance_along(axis)};
    expect_covariance_of(error_of(kFirst * disturbed(kSecond, error), kFirst * kSecond),
                         by_second.covariance);
    EXPECT_EQ(by_second.T_i_j.matrix(), (kFirst * kSecond).matrix());
  }
}

TEST(MeasuredMotion, TheErrorOfTheInverse) {
  for (int axis = 0; axis < 6; ++axis) {
    const MeasuredMotion back = MeasuredMotion{kFirst, covariance_along(axis)}.inverse();
    expect_covariance_of(error_of(disturbed(kFirst, error_along(axis)).inverse(), kFirst.inverse()),
                         back.covariance);
    EXPECT_EQ(back.T_i_j.matrix(), kFirst.inverse().matrix());
  }
}

}  // namespace
}  // namespace traverse::pose_graph
