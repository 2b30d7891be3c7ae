#include "traverse/geodesy/map_grid.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

namespace traverse::geodesy {
namespace {

TEST(MapGrid, CubesAreTheProjectionToAFractionOfAMillimetre) {
  for (const Geodetic& origin :
       {Geodetic{48.1, 11.5, 520}, Geodetic{-33.9, 18.4, 30}, Geodetic{72, 21, 10}}) {
    MapGrid grid(origin);
    for (int k = -40; k <= 40; ++k) {
      const Eigen::Vector3d enu(61.3 * k, 17.9 * k + 5, 0.7 * k);
      EXPECT_LT((grid.to_grid(enu) - grid.project(enu)).norm(), 1e-4) << origin.latitude_deg;
    }
  }
}

TEST(MapGrid, StaysInTheZoneOfItsOrigin) {
  MapGrid grid({47, 11.9999, 0});  // 7.6 m before zone 33
  EXPECT_EQ(grid.zone(), 32);
  EXPECT_EQ(grid.epsg(), 32632);
  const Eigen::Vector3d west = grid.project({-10, 0, 0});
  const Eigen::Vector3d east = grid.project({30, 0, 0});
  EXPECT_NEAR((east - west).norm(), 40, 0.02);
}

TEST(MapGrid, HasOneHemisphereOnTheEquator) {
  MapGrid grid({-1e-5, 9, 0});
  EXPECT_EQ(grid.epsg(), 32732);
  EXPECT_NEAR(grid.project({0, 5, 0}).y() - grid.project({0, -5, 0}).y(), 9.996, 1e-3);
}

TEST(MapGrid, IsPolarBeyond84Degrees) {
  EXPECT_EQ(MapGrid({85, 20, 0}).epsg(), 5041);
  EXPECT_EQ(MapGrid({-85, 20, 0}).epsg(), 5042);
  EXPECT_THROW(MapGrid({95, 20, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::geodesy
