#include <gtest/gtest.h>

#include "traverse/inertial/factor_kinds.hpp"

#include "optimization/checked_factors.hpp"

namespace traverse::inertial {
namespace {

TEST(FactorKinds, PassTheAuditAwayFromZeroResidual) {
  testing::expect_audit_passes(factor_kinds());
}

TEST(FactorKinds, ShowTheFourteenBlocksOfTheInertialFactor) {
  std::size_t blocks = 0;
  for (const optimization::FactorKind& kind : factor_kinds()) {
    if (kind.name.starts_with("inertial")) blocks += kind.blocks.size();
  }
  EXPECT_EQ(blocks, 14U);
}

TEST(FactorKinds, PassCeresOwnGradientChecker) {
  testing::expect_gradient_checker_passes(factor_kinds());
}

}  // namespace
}  // namespace traverse::inertial
