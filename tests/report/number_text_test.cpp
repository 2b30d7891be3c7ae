#include "page/number_text.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "traverse/files/numbers.hpp"

namespace traverse::report {
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

TEST(FullNumber, KeepsEveryDigit) { EXPECT_EQ(files::parse_double(full_number(1.0 / 3)), 1.0 / 3); }

TEST(Texts, CountsBytesAndDurations) {
  EXPECT_EQ(count_text(1234567), "1\u2009234\u2009567");
  EXPECT_EQ(count_text(12), "12");
  EXPECT_EQ(plural(1, "frame"), "1 frame");
  EXPECT_EQ(plural(0, "frame"), "0 frames");
  EXPECT_EQ(bytes_text(211e6), "211.0 MB");
  EXPECT_EQ(duration_text(43.21), "43.2 s");
  EXPECT_EQ(duration_text(3720), "1 h 02 min");
}

}  // namespace
}  // namespace traverse::report
