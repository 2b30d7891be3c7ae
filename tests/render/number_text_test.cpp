#include "plot/number_text.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace traverse::render {
namespace {

TEST(NumberText, GroupsThousandsFromFiveDigitsOn) {
  EXPECT_EQ(fixed_text(9999, 0), "9999");
  EXPECT_EQ(fixed_text(-1234567.25, 1), "−1\u2009234\u2009567.2");
  EXPECT_EQ(count_text(1'013'759), "1\u2009013\u2009759");
}

TEST(NumberText, ZeroHasNoSign) {
  EXPECT_EQ(fixed_text(-0.0, 1), "0.0");
  EXPECT_EQ(fixed_text(-0.04, 1), "0.0");
}

TEST(NumberText, ShowsSignificantDigits) {
  EXPECT_EQ(value_text(0.18449), "0.184");
  EXPECT_EQ(value_text(12.345), "12.3");
  EXPECT_EQ(value_text(107.2), "107");
  EXPECT_EQ(value_text(9.996), "10.0");
  EXPECT_EQ(value_text(-1234, 2), "−1200");
  EXPECT_EQ(value_text(0), "0");
}

TEST(NumberText, TakesPowersOfTenOnlyForExtremes) {
  EXPECT_EQ(value_text(2.5e-6), "2.50·10⁻⁶");
  EXPECT_EQ(value_text(3e12, 1), "3·10¹²");
  EXPECT_EQ(value_text(0.00012), "0.000120");
}

TEST(NumberText, NoNumberIsADash) {
  EXPECT_EQ(value_text(std::numeric_limits<double>::quiet_NaN()), "–");
  EXPECT_EQ(fixed_text(std::numeric_limits<double>::infinity(), 2), "–");
}

}  // namespace
}  // namespace traverse::render
