#include "traverse/files/number_text.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "traverse/files/numbers.hpp"

namespace traverse::files {
namespace {

TEST(ShortNumber, ShowsThreeOrFourDigits) {
  EXPECT_EQ(short_number(0), "0");
  EXPECT_EQ(short_number(0.066294), "0.0663");
  EXPECT_EQ(short_number(1.23456), "1.23");
  EXPECT_EQ(short_number(12.3456), "12.3");
  EXPECT_EQ(short_number(106.92), "106.9");
  EXPECT_EQ(short_number(-2.008), "\u22122.01");
  EXPECT_EQ(short_number(1234567), "1.23e+06");
  EXPECT_EQ(short_number(0.0000123), "1.23e-05");
  EXPECT_EQ(short_number(std::numeric_limits<double>::quiet_NaN()), "\u2013");
}

TEST(FullNumber, KeepsEveryDigit) { EXPECT_EQ(parse_double(full_number(1.0 / 3)), 1.0 / 3); }

TEST(NumberTexts, CountsBytesAndDurations) {
  EXPECT_EQ(count_text(1234567), "1\u2009234\u2009567");
  EXPECT_EQ(count_text(12345), "12\u2009345");
  EXPECT_EQ(count_text(1234), "1234");
  EXPECT_EQ(plural(1, "frame"), "1 frame");
  EXPECT_EQ(plural(0, "frame"), "0 frames");
  EXPECT_EQ(noun(1, "frame"), "frame");
  EXPECT_EQ(bytes_text(211e6), "211.0 MB");
  EXPECT_EQ(duration_text(43.21), "43.2 s");
  EXPECT_EQ(duration_text(3720), "1 h 02 min");
}

TEST(NumberTexts, ClockRunsOverAtSixty) {
  EXPECT_EQ(clock_text(0), "0:00");
  EXPECT_EQ(clock_text(59.6), "1:00");
  EXPECT_EQ(clock_text(3599.5), "1:00:00");
  EXPECT_EQ(clock_text(3750), "1:02:30");
  EXPECT_EQ(clock_text(-1), "0:00");
  EXPECT_EQ(clock_text(3.25, 2), "0:03.25");
  EXPECT_EQ(clock_text(59.999, 2), "1:00.00");
}

}  // namespace
}  // namespace traverse::files
