#include "traverse/evaluation/statistics.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace traverse::evaluation {
namespace {

TEST(Statistics, OfFourValues) {
  const Statistics s = statistics_of(std::vector<double>{4, 1, 3, 2});
  EXPECT_EQ(s.count, 4U);
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.sse, 30);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(7.5));
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(1.25));
  EXPECT_EQ(s.min, 1);
  EXPECT_EQ(s.max, 4);
}

TEST(Statistics, OfOneValue) {
  const Statistics s = statistics_of(std::vector<double>{3});
  EXPECT_EQ(s.median, 3);
  EXPECT_EQ(s.std, 0);
  EXPECT_THROW(statistics_of({}), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::evaluation
