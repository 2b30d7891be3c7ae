#include "traverse/geodesy/local_tangent_plane.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace traverse::geodesy {
namespace {

const Geodetic kBeijing{39.9, 116.4, 50};

TEST(LocalTangentPlane, HasEastNorthAndUpAtItsOrigin) {
  const LocalTangentPlane plane(kBeijing);
  EXPECT_LT(plane.to_enu(kBeijing).norm(), 1e-9);
  // One arc second: the radii of curvature of WGS84 at this latitude are 6369 km and 6387 km.
  const Eigen::Vector3d north = plane.to_enu({39.9 + 1.0 / 3600, 116.4, 50});
  EXPECT_NEAR(north.y(), 30.844, 1e-2);
  EXPECT_NEAR(north.x(), 0, 1e-9);
  const Eigen::Vector3d east = plane.to_enu({39.9, 116.4 + 1.0 / 3600, 50});
  EXPECT_NEAR(east.x(), 23.753, 1e-2);
  EXPECT_NEAR(east.y(), 0, 1e-2);
  EXPECT_NEAR(plane.to_enu({39.9, 116.4, 57}).z(), 7, 1e-9);
}

TEST(LocalTangentPlane, FallsBelowTheEllipsoidWithTheSquareOfTheDistance) {
  const LocalTangentPlane plane(kBeijing);
  const Eigen::Vector3d far = plane.to_enu({40.0, 116.4, 50});  // 11.1 km
  EXPECT_NEAR(far.z(), -far.y() * far.y() / (2 * 6.369e6), 0.05);
}

TEST(LocalTangentPlane, ComesBack) {
  const LocalTangentPlane plane(kBeijing);
  const Geodetic place = plane.to_geodetic(plane.to_enu({39.93, 116.35, -20}));
  EXPECT_NEAR(place.latitude_deg, 39.93, 1e-12);
  EXPECT_NEAR(place.longitude_deg, 116.35, 1e-12);
  EXPECT_NEAR(place.altitude_m, -20, 1e-8);
}

TEST(LocalTangentPlane, GravityGrowsFromTheEquatorToThePoles) {
  EXPECT_NEAR(LocalTangentPlane({0, 0, 0}).gravity(), 9.7803, 1e-4);
  EXPECT_NEAR(LocalTangentPlane({90, 0, 0}).gravity(), 9.8322, 1e-4);
}

TEST(LocalTangentPlane, RefusesWhatIsNoPlace) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(LocalTangentPlane({91, 0, 0}), std::invalid_argument);
  EXPECT_THROW(LocalTangentPlane({nan, 0, 0}), std::invalid_argument);
  EXPECT_THROW(LocalTangentPlane({0, 0, nan}), std::invalid_argument);
}

TEST(Utm, TellsHowFarGridNorthIsFromTrueNorth) {
  const Utm utm = to_utm({39.9, 116.4, 50});
  EXPECT_EQ(utm.zone, 50);
  EXPECT_TRUE(utm.is_north);
  EXPECT_NEAR(utm.convergence_deg, -0.385, 1e-3);
}

TEST(Utm, StaysInAZoneWhenAsked) {
  const Geodetic west_of_the_edge{39.9, 119.999, 0};
  const Geodetic east_of_the_edge{39.9, 120.001, 0};
  EXPECT_EQ(to_utm(east_of_the_edge).zone, 51);
  const Utm stayed = to_utm(east_of_the_edge, 50);
  EXPECT_EQ(stayed.zone, 50);
  EXPECT_LT(std::abs(stayed.easting_m - to_utm(west_of_the_edge).easting_m), 200);
  EXPECT_THROW(to_utm(east_of_the_edge, 20), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::geodesy
