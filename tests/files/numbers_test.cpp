#include "traverse/files/numbers.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace traverse::files {
namespace {

using ::testing::ElementsAre;

TEST(Numbers, TakesWholeWordsOnly) {
  EXPECT_EQ(parse_double("-2.5e-3"), -2.5e-3);
  EXPECT_EQ(parse_double("+1"), 1.0);
  EXPECT_TRUE(std::isnan(*parse_double("nan")));
  EXPECT_EQ(parse_integer("-7"), -7);
  for (const char* text : {"", "1x", " 1", "1 ", "1,5", "0x10", "--1"}) {
    EXPECT_FALSE(parse_double(text)) << text;
    EXPECT_FALSE(parse_integer(text)) << text;
  }
  EXPECT_FALSE(parse_integer("1.5"));
}

TEST(Numbers, TextReadsBackToTheSameBits) {
  for (const double value : {0.1, 1.0 / 3, -1e-300, 5e-324, std::numeric_limits<double>::max()}) {
    EXPECT_EQ(parse_double(to_text(value)), value);
  }
}

TEST(Split, WordsAndCells) {
  EXPECT_THAT(split_words("  a\tbc  d \r"), ElementsAre("a", "bc", "d"));
  EXPECT_THAT(split_words("   "), ElementsAre());
  EXPECT_THAT(split_words("a b c", 2), ElementsAre("a", "b"));
  EXPECT_THAT(split_cells("a, b ,,c", ','), ElementsAre("a", "b", "", "c"));
}

}  // namespace
}  // namespace traverse::files
