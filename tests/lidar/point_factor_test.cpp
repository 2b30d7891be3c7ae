#include "point_factor.hpp"

#include <vector>

#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include "geometry/random_motion.hpp"

namespace traverse::lidar {
namespace {

using testing::RandomMotion;

struct Blocks {
  explicit Blocks(const geometry::Pose3& pose) : q(pose.quaternion()), t(pose.translation) {}
  Eigen::Quaterniond q;
  Eigen::Vector3d t;
};

/// Ceres' own check, with the manifold, away from zero residual.
template <typename Factor>
void expect_gradient_checker_passes(const Factor& factor, const geometry::Pose3& pose) {
  RotationManifold rotation;
  const std::vector<const ceres::Manifold*> manifolds{&rotation, nullptr};
  ceres::NumericDiffOptions options;
  // The residuals bend on the scale of radians: Ridders' default first step, a hundredth of each
  // value, can end his extrapolation early with errors of 1e-3.
  options.ridders_relative_initial_step_size = 1e-4;
  const ceres::GradientChecker checker(&factor, &manifolds, options);
  Blocks blocks(pose);
  const double* parameters[] = {blocks.q.coeffs().data(), blocks.t.data()};
  ceres::GradientChecker::ProbeResults results;
  EXPECT_TRUE(checker.Probe(parameters, 1e-6, &results)) << results.error_log;
}

/// Our own check: central differences of the residual over the right perturbation.
template <typename Residual>
void expect_tangent_jacobian_matches(const PointFactor<Residual>& factor,
                                     const geometry::Pose3& pose) {
  constexpr int kSize = Residual::kSize;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  const auto residual = [&](const geometry::Pose3& T) {
    Blocks blocks(T);
    const double* parameters[] = {blocks.q.coeffs().data(), blocks.t.data()};
    Vector r;
    factor.Evaluate(parameters, r.data(), nullptr);
    return r;
  };
  Blocks blocks(pose);
  const double* parameters[] = {blocks.q.coeffs().data(), blocks.t.data()};
  Eigen::Matrix<double, kSize, 4, Eigen::RowMajor> ambient;
  Eigen::Matrix<double, kSize, 3, Eigen::RowMajor> translation;
  double* jacobians[] = {ambient.data(), translation.data()};
  Vector r;
  factor.Evaluate(parameters, r.data(), jacobians);
  const Eigen::Matrix<double, kSize, 3> rotation =
      ambient * RotationManifold::plus_jacobian(blocks.q.coeffs().data());

  const double step = 1e-6;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d d = step * Eigen::Vector3d::Unit(k);
    const auto turned = [&](const Eigen::Vector3d& delta) {
      return geometry::Pose3{pose.rotation * geometry::exp_so3(delta), pose.translation};
    };
    const auto moved = [&](const Eigen::Vector3d& delta) {
      return geometry::Pose3{pose.rotation, pose.translation + delta};
    };
    const Vector by_rotation = (residual(turned(d)) - residual(turned(-d))) / (2 * step);
    const Vector by_translation = (residual(moved(d)) - residual(moved(-d))) / (2 * step);
    EXPECT_LT((rotation.col(k) - by_rotation).norm(), 1e-7);
    EXPECT_LT((translation.col(k) - by_translation).norm(), 1e-7);
  }
}

template <typename Residual>
Residual random_residual(RandomMotion& random);
template <>
LineVectorResidual random_residual(RandomMotion& random) {
  return {Line{random.vector(10), random.vector(1).normalized()}};
}
template <>
LineDistanceResidual random_residual(RandomMotion& random) {
  return {Line{random.vector(10), random.vector(1).normalized()}};
}
template <>
PlaneResidual random_residual(RandomMotion& random) {
  return {Plane{random.vector(1).normalized(), random.uniform(-5, 5)}};
}

template <typename Residual>
class PointFactorTest : public ::testing::Test {};
using Residuals = ::testing::Types<LineVectorResidual, LineDistanceResidual, PlaneResidual>;
TYPED_TEST_SUITE(PointFactorTest, Residuals);

TYPED_TEST(PointFactorTest, PassesTheGradientChecker) {
  RandomMotion random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const PointFactor<TypeParam> factor(random.vector(20), random_residual<TypeParam>(random));
    expect_gradient_checker_passes(factor, random.pose(3, 10));
  }
}

TYPED_TEST(PointFactorTest, TangentJacobianIsThatOfTheRightPerturbation) {
  RandomMotion random(2);
  for (int trial = 0; trial < 20; ++trial) {
    const PointFactor<TypeParam> factor(random.vector(20), random_residual<TypeParam>(random));
    expect_tangent_jacobian_matches(factor, random.pose(3, 10));
  }
}

}  // namespace
}  // namespace traverse::lidar
