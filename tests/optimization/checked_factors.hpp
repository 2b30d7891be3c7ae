#pragma once

#include <vector>

#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include "traverse/optimization/factor_kind.hpp"
#include "traverse/optimization/jacobian_audit.hpp"
#include "traverse/optimization/rotation_manifold.hpp"

/// What the tests of every library expect of the factors that it registers.
namespace traverse::testing {

/// The audit that check-jacobians makes, at states where no residual is zero.
inline void expect_audit_passes(const std::vector<optimization::FactorKind>& kinds) {
  optimization::AuditOptions options;
  options.states = 40;
  const auto audit = optimization::audit_jacobians(kinds, options);
  EXPECT_EQ(audit.factors.size(), kinds.size());
  EXPECT_TRUE(audit.passed());
  for (const auto& factor : audit.factors) {
    EXPECT_GT(factor.min_residual, 1e-6) << factor.factor;
    for (const auto& block : factor.blocks) {
      EXPECT_TRUE(block.passed) << factor.factor << ", " << block.block << ": automatic "
                                << block.automatic.relative << ", numeric "
                                << block.numeric.relative;
    }
  }
}

/// Ceres' own comparison with numeric derivatives on the manifolds.
inline void expect_gradient_checker_passes(const std::vector<optimization::FactorKind>& kinds) {
  using optimization::Perturbation;
  const optimization::RotationManifold rotation(Perturbation::kRight);
  ceres::NumericDiffOptions options;
  options.ridders_relative_initial_step_size = 1e-4;
  optimization::RandomStates random(7);
  for (const optimization::FactorKind& kind : kinds) {
    std::vector<const ceres::Manifold*> manifolds;
    for (const auto& block : kind.blocks) {
      manifolds.push_back(block.is_rotation ? &rotation : nullptr);
    }
    const auto sample = kind.make(random, Perturbation::kRight);
    std::vector<const double*> parameters;
    for (const auto& block : sample.state) parameters.push_back(block.data());
    const ceres::GradientChecker checker(sample.analytic.get(), &manifolds, options);
    ceres::GradientChecker::ProbeResults results;
    checker.Probe(parameters.data(), 1e-6, &results);
    // Probe's verdict divides entry by entry, also those that are zero but for rounding.
    for (std::size_t k = 0; k < kind.blocks.size(); ++k) {
      const auto& analytic = results.local_jacobians[k];
      const auto& numeric = results.local_numeric_jacobians[k];
      EXPECT_LT((analytic - numeric).cwiseAbs().maxCoeff(), 1e-6 * analytic.cwiseAbs().maxCoeff())
          << kind.name << ", " << kind.blocks[k].name;
    }
  }
}

}  // namespace traverse::testing
