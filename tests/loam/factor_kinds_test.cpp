#include "traverse/loam/factor_kinds.hpp"

#include <gtest/gtest.h>

#include "traverse/optimization/jacobian_audit.hpp"

namespace traverse::loam {
namespace {

using optimization::AuditOptions;
using optimization::Perturbation;

TEST(FactorKinds, AllPassOnBothSidesFarFromZeroResidual) {
  const auto audit = optimization::audit_jacobians(factor_kinds(), AuditOptions{});
  EXPECT_EQ(audit.factors.size(), 16U);  // four residuals, deskewed and swept, two sides
  for (const optimization::FactorAudit& factor : audit.factors) {
    EXPECT_TRUE(factor.passed) << factor.factor << " " << name_of(factor.perturbation);
    EXPECT_GE(factor.min_residual, 0.49) << factor.factor;
    for (const optimization::BlockAudit& block : factor.blocks) {
      EXPECT_GT(block.largest_entry, 0.5) << factor.factor;
      EXPECT_LT(block.automatic.relative, 1e-12) << factor.factor << " " << block.block;
      EXPECT_LT(block.numeric.relative, 1e-8) << factor.factor << " " << block.block;
    }
  }
}

TEST(FactorKinds, EveryChoiceOfTheSolverIsOneOfThem) {
  const auto kinds = factor_kinds();
  for (const LineForm line : {LineForm::kVector, LineForm::kDistance}) {
    for (const PlaneForm plane : {PlaneForm::kSigned, PlaneForm::kAbsolute}) {
      for (const Perturbation side : {Perturbation::kRight, Perturbation::kLeft}) {
        SolverOptions options;
        options.line_form = line;
        options.plane_form = plane;
        options.perturbation = side;
        for (const Sweep sweep : {Sweep::kDeskewed, Sweep::kSwept}) {
          const auto used = selected(kinds, factors_of(options, sweep));
          ASSERT_EQ(used.size(), 2U);
          EXPECT_EQ(used[0].perturbations, std::vector{side});
          EXPECT_NE(used[0].name, used[1].name);
        }
      }
    }
  }
}

}  // namespace
}  // namespace traverse::loam
