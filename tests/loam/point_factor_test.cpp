#include "point_factor.hpp"

#include <vector>

#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include "geometry/random_motion.hpp"
#include "point_factor_list.hpp"

namespace traverse::loam {
namespace {

using optimization::Derivative;
using optimization::Perturbation;
using optimization::RotationManifold;
using testing::RandomMotion;

constexpr Perturbation kBothSides[] = {Perturbation::kRight, Perturbation::kLeft};
constexpr double kFractions[] = {1.0, 0.35};

struct Blocks {
  explicit Blocks(const geometry::Pose3& pose) : q(pose.quaternion()), t(pose.translation) {}
  Eigen::Quaterniond q;
  Eigen::Vector3d t;
};

/// A factor's value and ambient Jacobians at a pose.
template <int kSize>
struct Evaluated {
  Eigen::Matrix<double, kSize, 1> r;
  Eigen::Matrix<double, kSize, 4, Eigen::RowMajor> by_quaternion;
  Eigen::Matrix<double, kSize, 3, Eigen::RowMajor> by_translation;

  Evaluated(const ceres::CostFunction& factor, const geometry::Pose3& pose) {
    const Blocks blocks(pose);
    const double* parameters[] = {blocks.q.coeffs().data(), blocks.t.data()};
    double* jacobians[] = {by_quaternion.data(), by_translation.data()};
    factor.Evaluate(parameters, r.data(), jacobians);
  }
};

/// Ceres' own check, with the manifold, away from zero residual.
void expect_gradient_checker_passes(const ceres::CostFunction& factor, Perturbation side,
                                    const geometry::Pose3& pose) {
  const RotationManifold rotation(side);
  const std::vector<const ceres::Manifold*> manifolds{&rotation, nullptr};
  ceres::NumericDiffOptions options;
  // The residuals bend on the scale of radians: Ridders' default first step, a hundredth of each
  // value, can end his extrapolation early with errors of 1e-3.
  options.ridders_relative_initial_step_size = 1e-4;
  const ceres::GradientChecker checker(&factor, &manifolds, options);
  const Blocks blocks(pose);
  const double* parameters[] = {blocks.q.coeffs().data(), blocks.t.data()};
  ceres::GradientChecker::ProbeResults results;
  EXPECT_TRUE(checker.Probe(parameters, 1e-6, &results)) << results.error_log;
}

/// Our own check: central differences of the residual over the perturbation.
template <typename Residual>
void expect_tangent_jacobian_matches(const PointFactor<Residual>& factor, Perturbation side,
                                     const geometry::Pose3& pose) {
  using Values = Evaluated<Residual::kSize>;
  const Values at_pose(factor, pose);
  const Eigen::Matrix<double, Residual::kSize, 3> rotation =
      at_pose.by_quaternion * RotationManifold::plus_jacobian(Blocks(pose).q.coeffs().data(), side);
  const auto turned = [&](const Eigen::Vector3d& d) {
    const Eigen::Matrix3d E = geometry::exp_so3(d);
    const Eigen::Matrix3d R =
        side == Perturbation::kRight ? Eigen::Matrix3d(pose.rotation * E) : E * pose.rotation;
    return Values(factor, {R, pose.translation}).r;
  };
  const auto moved = [&](const Eigen::Vector3d& d) {
    return Values(factor, {pose.rotation, pose.translation + d}).r;
  };
  const double step = 1e-6;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d d = step * Eigen::Vector3d::Unit(k);
    EXPECT_LT((rotation.col(k) - (turned(d) - turned(-d)) / (2 * step)).norm(), 1e-7);
    EXPECT_LT((at_pose.by_translation.col(k) - (moved(d) - moved(-d)) / (2 * step)).norm(), 1e-7);
  }
}

template <typename Residual>
Residual random_residual(RandomMotion& random) {
  if constexpr (requires(Residual residual) { residual.line; }) {
    return {Line{random.vector(10), random.vector(1).normalized()}};
  } else {
    return {Plane{random.vector(1).normalized(), random.uniform(-5, 5)}};
  }
}

template <typename Residual>
class PointFactorTest : public ::testing::Test {};
using Residuals = ::testing::Types<LineVectorResidual, LineDistanceResidual, PlaneResidual,
                                   PlaneDistanceResidual>;
TYPED_TEST_SUITE(PointFactorTest, Residuals);

TYPED_TEST(PointFactorTest, PassesTheGradientChecker) {
  RandomMotion random(1);
  for (int trial = 0; trial < 10; ++trial) {
    const auto residual = random_residual<TypeParam>(random);
    const Eigen::Vector3d p = random.vector(20);
    const geometry::Pose3 pose = random.pose(2.5, 10);
    for (const double fraction : kFractions) {
      for (const Perturbation side : kBothSides) {
        const PointFactor<TypeParam> factor(PointMotion(p, fraction, side), residual);
        expect_gradient_checker_passes(factor, side, pose);
      }
    }
  }
}

TYPED_TEST(PointFactorTest, TangentJacobianIsThatOfThePerturbation) {
  RandomMotion random(2);
  for (int trial = 0; trial < 20; ++trial) {
    const auto residual = random_residual<TypeParam>(random);
    const Eigen::Vector3d p = random.vector(20);
    const geometry::Pose3 pose = random.pose(2.5, 10);
    for (const double fraction : kFractions) {
      for (const Perturbation side : kBothSides) {
        const PointFactor<TypeParam> factor(PointMotion(p, fraction, side), residual);
        expect_tangent_jacobian_matches(factor, side, pose);
      }
    }
  }
}

TYPED_TEST(PointFactorTest, AutomaticAndNumericDerivativesAgree) {
  RandomMotion random(3);
  PointFactorList<TypeParam> list;
  for (int trial = 0; trial < 20; ++trial) {
    const auto residual = random_residual<TypeParam>(random);
    const Eigen::Vector3d p = random.vector(20);
    // From the identity on, where an unguarded logarithm has no automatic derivative.
    const geometry::Pose3 pose = random.pose(trial == 0 ? 0 : 2.5, trial == 0 ? 0 : 10);
    for (const double fraction : kFractions) {
      for (const Perturbation side : kBothSides) {
        const PointMotion motion(p, fraction, side);
        const auto evaluated = [&](Derivative derivative) {
          return Evaluated<TypeParam::kSize>(*list.add(motion, residual, derivative), pose);
        };
        const auto analytic = evaluated(Derivative::kAnalytic);
        const auto automatic = evaluated(Derivative::kAutomatic);
        const auto numeric = evaluated(Derivative::kNumeric);
        EXPECT_LT((analytic.r - automatic.r).norm(), 1e-12);
        EXPECT_LT((analytic.r - numeric.r).norm(), 1e-12);
        EXPECT_LT((analytic.by_quaternion - automatic.by_quaternion).norm(), 1e-11);
        EXPECT_LT((analytic.by_quaternion - numeric.by_quaternion).norm(), 1e-4);
        EXPECT_LT((analytic.by_translation - automatic.by_translation).norm(), 1e-13);
        EXPECT_LT((analytic.by_translation - numeric.by_translation).norm(), 1e-5);
      }
    }
  }
}

TEST(LineDistanceFactor, EveryDerivativeIsZeroOnTheLineItself) {
  PointFactorList<LineDistanceResidual> list;
  const LineDistanceResidual residual{Line{{1, 2, 3}, {0, 0, 1}}};
  const PointMotion motion({1, 2, 7}, 1, Perturbation::kRight);
  for (const Derivative derivative :
       {Derivative::kAnalytic, Derivative::kAutomatic, Derivative::kNumeric}) {
    const Evaluated<1> values(*list.add(motion, residual, derivative), {});
    EXPECT_EQ(values.r[0], 0);
    EXPECT_LT(values.by_quaternion.norm(), 1e-6) << name_of(derivative);
    EXPECT_LT(values.by_translation.norm(), 1e-6) << name_of(derivative);
  }
}

}  // namespace
}  // namespace traverse::loam
