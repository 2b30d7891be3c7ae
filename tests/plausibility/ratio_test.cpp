#include "comparison/ratio.hpp"

#include <random>

#include <gtest/gtest.h>

namespace traverse::plausibility {
namespace {

TEST(Ratio, IsThatOfTheLargerHalf) {
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  Ratio ratio;
  for (int i = 0; i < 100; ++i) {
    const double x = normal(generator);
    const bool is_outlier = i % 5 == 0;
    ratio.add(x, is_outlier ? 40 * normal(generator) : 3 * x + 0.05 * normal(generator));
  }
  const auto found = ratio.find(50, 10);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->value, 3, 0.05);
  EXPECT_TRUE(found->is_consistent());
  EXPECT_TRUE(found->is_near(2.5));
  EXPECT_FALSE(found->is_near(1));
  EXPECT_FALSE(found->is_near(-3));
}

TEST(Ratio, SaysNothingOfNothing) {
  Ratio ratio;
  EXPECT_FALSE(ratio.find(0, 0.1));
  ratio.add(0, 5);
  EXPECT_FALSE(ratio.find(1, 0));
  ratio.add(1, 5);
  EXPECT_FALSE(ratio.find(2, 0));
  EXPECT_FALSE(ratio.find(1, 1.5));
  EXPECT_DOUBLE_EQ(ratio.find(1, 1)->value, 5);
}

TEST(Ratio, OneHugePairDoesNotOutweighTheOthers) {
  Ratio ratio;
  for (int i = 0; i < 30; ++i) ratio.add(1, 2);
  ratio.add(100, 1);
  ratio.add(-90, 1);
  EXPECT_DOUBLE_EQ(ratio.find(5, 1)->value, 2);
}

TEST(Ratio, WithoutAFactorInCommonIsNotConsistent) {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  Ratio ratio;
  for (int i = 0; i < 200; ++i) {
    const double x = normal(generator);
    const double y = normal(generator);
    ratio.add(x, y);
  }
  EXPECT_FALSE(ratio.find(50, 10)->is_consistent());
}

}  // namespace
}  // namespace traverse::plausibility
