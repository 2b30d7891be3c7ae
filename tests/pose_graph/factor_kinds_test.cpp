#include "traverse/pose_graph/factor_kinds.hpp"

#include <gtest/gtest.h>

#include "optimization/checked_factors.hpp"

namespace traverse::pose_graph {
namespace {

TEST(FactorKinds, PassTheAuditAwayFromZeroResidual) {
  EXPECT_EQ(factor_kinds().size(), 3U);
  testing::expect_audit_passes(factor_kinds());
}

TEST(FactorKinds, PassCeresOwnGradientChecker) {
  testing::expect_gradient_checker_passes(factor_kinds());
}

}  // namespace
}  // namespace traverse::pose_graph
