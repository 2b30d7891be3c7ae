#include "traverse/optimization/solution.hpp"

#include <limits>

#include <ceres/sized_cost_function.h>
#include <gtest/gtest.h>

namespace traverse::optimization {
namespace {

/// x - 3, where it can be evaluated.
class FromThree final : public ceres::SizedCostFunction<1, 1> {
 public:
  explicit FromThree(bool can_be_evaluated) : can_be_evaluated_(can_be_evaluated) {}

  bool Evaluate(double const* const* x, double* r, double** jacobians) const override {
    r[0] = x[0][0] - 3;
    if (jacobians != nullptr && jacobians[0] != nullptr) jacobians[0][0] = 1;
    return can_be_evaluated_;
  }

 private:
  bool can_be_evaluated_;
};

ceres::Solver::Options quiet() {
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  return options;
}

TEST(Solution, TellsStepsAndTheTrustRegion) {
  double x = 10;
  ceres::Problem problem;
  problem.AddResidualBlock(new FromThree(true), nullptr, &x);
  const Solution solution = solve(quiet(), problem);
  EXPECT_TRUE(solution.is_usable);
  EXPECT_TRUE(solution.converged);
  EXPECT_EQ(solution.reason, Termination::kConverged);
  EXPECT_GE(solution.iterations, 1);
  EXPECT_GT(solution.trust_region_radius.value(), 0);
  EXPECT_NEAR(x, 3, 1e-3);
}

TEST(Solution, WithNothingToMoveThereIsNoIteration) {
  double x = 10;
  ceres::Problem problem;
  problem.AddResidualBlock(new FromThree(true), nullptr, &x);
  problem.SetParameterBlockConstant(&x);
  for (int blocks = 1; blocks >= 0; --blocks) {
    const Solution solution = solve(quiet(), problem);
    EXPECT_TRUE(solution.is_usable);
    EXPECT_TRUE(solution.converged);
    EXPECT_EQ(solution.iterations, 0);
    EXPECT_FALSE(solution.trust_region_radius);
    EXPECT_FALSE(solution.message.empty());
    if (blocks > 0) problem.RemoveParameterBlock(&x);
  }
  EXPECT_EQ(x, 10);
}

TEST(Solution, OneWithoutIterationsLeftIsUsableAndSaysSo) {
  double x = 10;
  ceres::Problem problem;
  problem.AddResidualBlock(new FromThree(true), nullptr, &x);
  ceres::Solver::Options options = quiet();
  options.max_num_iterations = 1;
  options.initial_trust_region_radius = 1e-2;
  const Solution solution = solve(options, problem);
  EXPECT_TRUE(solution.is_usable);
  EXPECT_FALSE(solution.converged);
  EXPECT_EQ(solution.reason, Termination::kIterationLimit);
  EXPECT_EQ(solution.iterations, 1);
  EXPECT_LT(x, 10);
}

TEST(Solution, OneThatFailsSaysWhyAndMovesNothing) {
  for (const double start : {10.0, std::numeric_limits<double>::quiet_NaN()}) {
    double x = start;
    ceres::Problem problem;
    problem.AddResidualBlock(new FromThree(false), nullptr, &x);
    const Solution solution = solve(quiet(), problem);
    EXPECT_FALSE(solution.is_usable);
    EXPECT_FALSE(solution.converged);
    EXPECT_EQ(solution.reason, Termination::kNotSolvable);
    EXPECT_EQ(solution.iterations, 0);
    EXPECT_FALSE(solution.trust_region_radius);
    EXPECT_FALSE(solution.message.empty());
    EXPECT_TRUE(x == start || x != x);
  }
}

}  // namespace
}  // namespace traverse::optimization
