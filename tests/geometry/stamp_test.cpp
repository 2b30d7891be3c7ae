#include "traverse/geometry/stamp.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

namespace traverse::geometry {
namespace {

TEST(Stamp, TextIsExactWhereADoubleIsNot) {
  const auto stamp = parse_stamp_seconds("1317042145.123456789");
  ASSERT_TRUE(stamp);
  EXPECT_EQ(stamp->nanoseconds, 1317042145123456789);
  EXPECT_EQ(to_text(*stamp), "1317042145.123456789");
}

TEST(Stamp, ReadsTheFormsThatFilesUse) {
  EXPECT_EQ(parse_stamp_seconds("12")->nanoseconds, 12'000'000'000);
  EXPECT_EQ(parse_stamp_seconds("12.5")->nanoseconds, 12'500'000'000);
  EXPECT_EQ(parse_stamp_seconds("-0.5")->nanoseconds, -500'000'000);
  EXPECT_EQ(parse_stamp_seconds("1.5e3")->nanoseconds, 1'500'000'000'000);
  EXPECT_EQ(parse_stamp_seconds("0.30000000000000004")->nanoseconds, 300'000'000);
}

TEST(Stamp, RefusesWhatIsNoTime) {
  for (const char* text : {"", "abc", "1.2.3", "12 ", "nan", "inf", "9300000000", "1e300", "-"}) {
    EXPECT_FALSE(parse_stamp_seconds(text)) << text;
  }
}

TEST(Stamp, NegativeTimesPrintAndReadBack) {
  const Stamp stamp{-1'250'000'000};
  EXPECT_EQ(to_text(stamp), "-1.250000000");
  EXPECT_EQ(parse_stamp_seconds(to_text(stamp)), stamp);
}

TEST(Stamp, SecondsBetweenKeepsNanosecondsAtUnixTime) {
  const Stamp a{1317042145000000001};
  EXPECT_DOUBLE_EQ(seconds_between(a, Stamp{1317042145000000003}), 2e-9);
  EXPECT_DOUBLE_EQ(
      seconds_between(Stamp{-9'200'000'000'000'000'000}, Stamp{9'200'000'000'000'000'000}),
      1.84e10);
  EXPECT_EQ(shifted(a, -0.5).nanoseconds, 1317042144500000001);
}

TEST(Stamp, StaysWithinWhatSixtyFourBitsHold) {
  constexpr std::int64_t kFarthest = 9'200'000'000'000'000'000;
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  EXPECT_EQ(Stamp::from_seconds(1e300).nanoseconds, kFarthest);
  EXPECT_EQ(Stamp::from_seconds(-1e300).nanoseconds, -kFarthest);
  EXPECT_EQ(Stamp::from_seconds(std::nan("")).nanoseconds, 0);
  EXPECT_EQ(shifted(Stamp{5}, 1e300).nanoseconds, kFarthest);
  EXPECT_EQ(shifted(Stamp{kFarthest}, 9e9).nanoseconds, kFarthest);
  EXPECT_EQ(shifted(Stamp{-kFarthest}, -9e9).nanoseconds, -kFarthest);
  EXPECT_EQ(shifted(Stamp{7}, std::nan("")).nanoseconds, 7);
  EXPECT_EQ(to_text(Stamp{kLeast}), "-9223372036.854775808");
}

}  // namespace
}  // namespace traverse::geometry
