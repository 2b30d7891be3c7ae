#include "nmea.hpp"

#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace traverse::packets {
namespace {

std::string with_checksum(const std::string& body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  return fmt::format("${}*{:02X}", body, sum);
}

TEST(Nmea, RmcTellsPlaceTimeAndDay) {
  const auto fix = parse_nmea_fix(
      with_checksum("GPRMC,123519.5,A,4807.038,N,01131.000,W,022.4,084.4,230394,003.1,W"));
  ASSERT_TRUE(fix);
  EXPECT_DOUBLE_EQ(fix->seconds_of_day, 12 * 3600 + 35 * 60 + 19.5);
  EXPECT_NEAR(fix->latitude_deg, 48.1173, 1e-9);
  EXPECT_NEAR(fix->longitude_deg, -(11 + 31.0 / 60), 1e-12);
  EXPECT_FALSE(fix->altitude_m);
  EXPECT_EQ(fix->day, 45372);  // 2094-03-23
}

TEST(Nmea, GgaTellsTheAltitudeAboveTheEllipsoid) {
  const auto fix = parse_nmea_fix(
      with_checksum("GNGGA,000001,4807.038,S,01131.000,E,4,08,0.9,545.4,M,46.9,M,,"));
  ASSERT_TRUE(fix);
  EXPECT_NEAR(fix->latitude_deg, -48.1173, 1e-9);
  EXPECT_NEAR(*fix->altitude_m, 592.3, 1e-9);
  ASSERT_TRUE(fix->covariance_enu);
  EXPECT_NEAR((*fix->covariance_enu)(0, 0), 0.02 * 0.02, 1e-12) << "ambiguities are fixed";
  EXPECT_FALSE(fix->day);
}

TEST(Nmea, WhatIsNoFixGivesNone) {
  const std::string good = "GPRMC,123519,A,4807.038,N,01131.000,E,022.4,084.4,230394,003.1,W";
  EXPECT_TRUE(parse_nmea_fix(with_checksum(good)));
  EXPECT_FALSE(parse_nmea_fix("$" + good + "*00"));
  EXPECT_FALSE(parse_nmea_fix("$" + good));
  for (const auto& [from, to] :
       {std::pair(",A,", ",V,"), std::pair("4807.038", "9907.038"), std::pair("4807.038", ""),
        std::pair(",N,", ",X,"), std::pair("123519", "250000"), std::pair("GPRMC", "GPVTG")}) {
    std::string bad = good;
    bad.replace(bad.find(from), std::string(from).size(), to);
    EXPECT_FALSE(parse_nmea_fix(with_checksum(bad))) << bad;
  }
  for (const std::string quality : {"0", "6", "7", "8", "", "x"}) {  // none, or not measured
    EXPECT_FALSE(parse_nmea_fix(with_checksum("GPGGA,000001,4807.038,N,01131.000,E," + quality +
                                              ",08,0.9,545.4,M,46.9,M,,")))
        << quality;
  }
  EXPECT_FALSE(parse_nmea_fix(""));
  EXPECT_FALSE(parse_nmea_fix("$*"));
}

}  // namespace
}  // namespace traverse::packets
