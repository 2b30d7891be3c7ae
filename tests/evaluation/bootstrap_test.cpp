#include "traverse/evaluation/bootstrap.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace traverse::evaluation {
namespace {

/// Errors that remember the one before: e_k = memory e_(k-1) + noise, around `mean`.
std::vector<double> remembering(std::size_t count, double memory, double mean, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> noise(0, 1);
  std::vector<double> values(count);
  double state = noise(generator) / std::sqrt(1 - memory * memory);
  for (double& value : values) {
    value = mean + state;
    state = memory * state + noise(generator);
  }
  return values;
}

TEST(BlockLength, GrowsWithTheMemoryOfTheValues) {
  EXPECT_LE(block_length(remembering(2000, 0, 0, 1)), 4U);
  // Politis and White: (2 G^2 / D n)^(1/3) with G = 2 rho / (1 - rho)^2 / (1 - rho^2), spectrum
  // 1 / (1 - rho)^2 gives 38 for rho = 0.8 and n = 2000.
  EXPECT_NEAR(static_cast<double>(block_length(remembering(2000, 0.8, 0, 1))), 38, 15);
  EXPECT_EQ(block_length(std::vector<double>(100, 3.0)), 1U);
}

TEST(BootstrapInterval, CoversTheTrueMeanOfDependentValues) {
  BootstrapOptions options;
  options.resamples = 200;
  int covered = 0;
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto values = remembering(1000, 0.8, 5, 100U + static_cast<unsigned>(trial));
    const auto interval = bootstrap_interval(values, Figure::kMean, options);
    if (interval->low <= 5 && 5 <= interval->high) ++covered;
  }
  // Drawing single values covers the mean in about half of the trials.
  EXPECT_GE(covered, 0.87 * kTrials);
  EXPECT_LE(covered, 0.99 * kTrials);
}

TEST(BootstrapInterval, HoldsTheFigureAndRepeats) {
  const auto values = remembering(300, 0.5, 3, 7);
  for (const Figure figure : {Figure::kMean, Figure::kRmse, Figure::kMedian}) {
    const auto interval = bootstrap_interval(values, figure);
    EXPECT_LT(interval->low, figure_of(values, figure));
    EXPECT_GT(interval->high, figure_of(values, figure));
    EXPECT_EQ(bootstrap_interval(values, figure)->low, interval->low);
    EXPECT_NE(bootstrap_interval(values, figure, {0.95, 2000, 2})->low, interval->low);
  }
}

TEST(BootstrapInterval, IsNotDefinedForFewValues) {
  EXPECT_FALSE(bootstrap_interval(std::vector<double>(kFewestForInterval - 1, 1.0), Figure::kMean));
  EXPECT_TRUE(bootstrap_interval(std::vector<double>(kFewestForInterval, 1.0), Figure::kMean));
}

TEST(BootstrapDifference, SeesWhatIsTheSameAllAlong) {
  // The hardness of the road varies by 1; the candidate is better by 0.1 everywhere.
  const auto baseline = remembering(400, 0.8, 5, 3);
  const auto noise = remembering(400, 0, 0, 4);
  std::vector<double> candidate;
  for (std::size_t i = 0; i < baseline.size(); ++i) {
    candidate.push_back(baseline[i] - 0.1 + 0.05 * noise[i]);
  }
  const auto paired = bootstrap_difference(baseline, candidate, Figure::kMean);
  EXPECT_NEAR(paired->difference, -0.1, 0.01);
  EXPECT_LT(paired->interval.high, 0);
  const auto alone = bootstrap_interval(candidate, Figure::kMean);
  EXPECT_GT(alone->high - alone->low, 10 * (paired->interval.high - paired->interval.low));
}

TEST(BootstrapDifference, DoesNotTakeChanceForAChange) {
  const auto paired =
      bootstrap_difference(remembering(400, 0.8, 5, 3), remembering(400, 0.8, 5, 4), Figure::kRmse);
  EXPECT_LT(paired->interval.low, 0);
  EXPECT_GT(paired->interval.high, 0);
}

TEST(Bootstrap, RefusesWhatMakesNoSense) {
  const std::vector<double> values(30, 1.0);
  EXPECT_THROW(bootstrap_interval(values, Figure::kMean, {1.0, 100, 1}), std::invalid_argument);
  EXPECT_THROW(bootstrap_interval(values, Figure::kMean, {0.9, 1, 1}), std::invalid_argument);
  EXPECT_THROW(bootstrap_difference(values, std::vector<double>(29, 1.0), Figure::kMean),
               std::invalid_argument);
  EXPECT_THROW(figure_of({}, Figure::kMean), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::evaluation
