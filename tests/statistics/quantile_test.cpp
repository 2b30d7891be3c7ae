#include "traverse/statistics/quantile.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

namespace traverse::statistics {
namespace {

TEST(Quantile, IsLinearBetweenNeighbours) {
  const std::vector<double> values{4, 1, 3, 2};
  EXPECT_DOUBLE_EQ(quantile(values, 0), 1);
  EXPECT_DOUBLE_EQ(quantile(values, 1), 4);
  EXPECT_DOUBLE_EQ(quantile(values, 0.25), 1.75);
  EXPECT_DOUBLE_EQ(median(values), 2.5);
  EXPECT_DOUBLE_EQ(median(std::vector<double>{7}), 7);
}

TEST(Quantile, OfFloatsIsThatOfTheSameNumbers) {
  const std::vector<float> values{0.5F, 8, 2, 1};
  EXPECT_DOUBLE_EQ(quantile(values, 0.5), 1.5);
}

TEST(Quantile, NeedsAValueAndAShare) {
  EXPECT_THROW(quantile(std::vector<double>{}, 0.5), std::invalid_argument);
  EXPECT_THROW(quantile(std::vector<double>{1}, 1.5), std::invalid_argument);
}

TEST(ElementAtShare, IsOneOfTheValues) {
  std::vector<double> values{4, 1, 3, 2};
  EXPECT_EQ(element_at_share(values, 0.5), 3) << "the upper one of two in the middle";
  EXPECT_EQ(element_at_share(values, 0.25), 2);
  EXPECT_EQ(element_at_share(values, 1), 4);
}

}  // namespace
}  // namespace traverse::statistics
