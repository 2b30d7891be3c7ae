#include "traverse/geometry/stamp.hpp"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

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

TEST(Stamp, ExponentsAreTakenDigitByDigit) {
  EXPECT_EQ(parse_stamp_seconds("1.700000000099999905e+09")->nanoseconds, 1700000000099999905);
  EXPECT_EQ(parse_stamp_seconds("1.7E9")->nanoseconds, 1700000000000000000);
  EXPECT_EQ(parse_stamp_seconds("1e-9")->nanoseconds, 1);
  EXPECT_EQ(parse_stamp_seconds("4.9e-10")->nanoseconds, 0);
  EXPECT_EQ(parse_stamp_seconds("-5e-10")->nanoseconds, -1);
  EXPECT_EQ(parse_stamp_seconds("1e-300")->nanoseconds, 0);
  EXPECT_EQ(parse_stamp_seconds("0e99999")->nanoseconds, 0);
  EXPECT_EQ(parse_stamp_seconds(".5")->nanoseconds, 500'000'000);
  EXPECT_EQ(parse_stamp_seconds("000000000000012.")->nanoseconds, 12'000'000'000);
  for (const char* text :
       {"1e", "e5", "1e1.5", "1e99999999999999999999", ".", "+", "0x10", "1e10"}) {
    EXPECT_FALSE(parse_stamp_seconds(text)) << text;
  }
}

TEST(Stamp, NanosecondsAreWholeHoweverTheyAreWritten) {
  EXPECT_EQ(parse_stamp_nanoseconds("1403636580838555648")->nanoseconds, 1403636580838555648);
  EXPECT_EQ(parse_stamp_nanoseconds("1.403636580838555648e+18")->nanoseconds, 1403636580838555648);
  EXPECT_EQ(parse_stamp_nanoseconds("1.7e+18")->nanoseconds, 1700000000000000000);
  EXPECT_EQ(parse_stamp_nanoseconds("1700000000100000000.000")->nanoseconds, 1700000000100000000);
  EXPECT_EQ(parse_stamp_nanoseconds("-9223372036854775808")->nanoseconds,
            std::numeric_limits<std::int64_t>::min());
  for (const char* text : {"1.5", "1700000000.1", "1.25e1", "1e-1", "nan", "", "1e19", "5x"}) {
    EXPECT_FALSE(parse_stamp_nanoseconds(text)) << text;
  }
}

TEST(Stamp, UnitsOfUnixTimesAreToldByTheirSize) {
  EXPECT_EQ(unix_time_unit(1.7e9), UnixTimeUnit::kSeconds);
  EXPECT_EQ(unix_time_unit(1.7e12), UnixTimeUnit::kMilliseconds);
  EXPECT_EQ(unix_time_unit(1.7e15), UnixTimeUnit::kMicroseconds);
  EXPECT_EQ(unix_time_unit(1.7e18), UnixTimeUnit::kNanoseconds);
  EXPECT_FALSE(unix_time_unit(1e7));
  EXPECT_FALSE(unix_time_unit(9.3e18));
  EXPECT_FALSE(unix_time_unit(std::nan("")));
  for (const char* text :
       {"1700000000.5", "1700000000500", "1700000000500000", "1700000000500000000"}) {
    const auto unit = unix_time_unit(std::stod(text));
    ASSERT_TRUE(unit) << text;
    EXPECT_EQ(parse_unix_time(text, *unit)->nanoseconds, 1700000000500000000) << text;
    EXPECT_NEAR(std::stod(text) * seconds_of(*unit), 1.7e9, 1) << text;
  }
}

TEST(Stamp, NearestSecondsAreWhatReadingTheTextGives) {
  std::mt19937_64 random(1);
  const auto expect_nearest = [](std::int64_t nanoseconds) {
    const Stamp stamp{nanoseconds};
    ASSERT_EQ(nearest_seconds(stamp), std::strtod(to_text(stamp).c_str(), nullptr)) << nanoseconds;
  };
  for (int i = 0; i < 20000; ++i) {
    expect_nearest(static_cast<std::int64_t>(random() >> (1 + i % 60)));
    expect_nearest(-static_cast<std::int64_t>(random() >> (1 + i % 60)));
    // Half way between two doubles, where one rounding after another goes wrong.
    const std::int64_t step = 1'000'000'000 / 512;
    expect_nearest(1'700'000'000'000'000'000 + (2 * i + 1) * step + i % 3 - 1);
  }
  expect_nearest(std::numeric_limits<std::int64_t>::min());
  expect_nearest(0);
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
