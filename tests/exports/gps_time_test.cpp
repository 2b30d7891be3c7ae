#include "traverse/exports/gps_time.hpp"

#include <gtest/gtest.h>

namespace traverse::exports {
namespace {

using geometry::Stamp;

TEST(GpsTime, HasTheLeapSecondsOfItsDay) {
  const auto gps = [](std::int64_t unix_s) {
    return *adjusted_gps_time(Stamp{unix_s * 1'000'000'000}) + 1e9;
  };
  EXPECT_EQ(gps(315'964'800), 0);                // 1980-01-06
  EXPECT_EQ(gps(1'317'042'145), 1'001'077'360);  // 2011-09-26, 15 leap seconds
  EXPECT_EQ(gps(1'483'228'799), 1'167'264'016);  // the last second of 2016 but one
  EXPECT_EQ(gps(1'483'228'800), 1'167'264'018);  // 2017-01-01
  EXPECT_EQ(gps(1'700'000'000), 1'384'035'218);  // 2023-11-14
}

TEST(GpsTime, KeepsMicroseconds) {
  const double gps = *adjusted_gps_time(Stamp{1'700'000'000'123'456'000});
  EXPECT_NEAR(gps - 384'035'218.0, 0.123456, 1e-7);
}

TEST(GpsTime, IsNoneOfAClockWithoutADate) {
  EXPECT_FALSE(adjusted_gps_time(Stamp{12'000'000'000}));
  EXPECT_FALSE(adjusted_gps_time(Stamp{-1}));
}

}  // namespace
}  // namespace traverse::exports
