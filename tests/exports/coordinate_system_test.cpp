#include "traverse/exports/coordinate_system.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace traverse::exports {
namespace {

using ::testing::HasSubstr;

void expect_balanced(const std::string& wkt) {
  EXPECT_EQ(std::count(wkt.begin(), wkt.end(), '['), std::count(wkt.begin(), wkt.end(), ']'))
      << wkt;
  EXPECT_EQ(std::count(wkt.begin(), wkt.end(), '"') % 2, 0) << wkt;
}

TEST(CoordinateSystem, NamesZoneHemisphereAndHeights) {
  const std::string munich = grid_wkt(geodesy::MapGrid({48.1, 11.5, 520}));
  EXPECT_THAT(munich, HasSubstr(R"(PROJCS["WGS 84 / UTM zone 32N")"));
  EXPECT_THAT(munich, HasSubstr(R"("central_meridian",9])"));
  EXPECT_THAT(munich, HasSubstr(R"(AUTHORITY["EPSG","32632"])"));
  EXPECT_THAT(munich, HasSubstr(R"(VERT_DATUM["WGS 84 ellipsoid",2002])"));
  expect_balanced(munich);
  const std::string cape = grid_wkt(geodesy::MapGrid({-33.9, 18.4, 30}));
  EXPECT_THAT(cape, HasSubstr(R"(PROJCS["WGS 84 / UTM zone 34S")"));
  EXPECT_THAT(cape, HasSubstr(R"("false_northing",10000000])"));
  expect_balanced(cape);
  const std::string pole = grid_wkt(geodesy::MapGrid({-89, 0, 2800}));
  EXPECT_THAT(pole, HasSubstr(R"(PROJECTION["Polar_Stereographic"])"));
  EXPECT_THAT(pole, HasSubstr(R"("latitude_of_origin",-90])"));
  expect_balanced(pole);
}

TEST(CoordinateSystem, OfALocalFrameSaysWhereItIs) {
  const std::string here = local_wkt({48.1, 11.5, 520});
  EXPECT_THAT(here, HasSubstr("48.100000000 deg N, 11.500000000 deg E, 520.000 m"));
  expect_balanced(here);
  EXPECT_THAT(local_wkt(), HasSubstr("tied to no place"));
  expect_balanced(local_wkt());
}

}  // namespace
}  // namespace traverse::exports
