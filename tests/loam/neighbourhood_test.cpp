#include "traverse/loam/neighbourhood.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace traverse::loam {
namespace {

TEST(FitLine, FindsThePoleAndRefusesTheWall) {
  const std::vector<Eigen::Vector3d> pole{
      {5, 2, 0}, {5.01, 2, 0.3}, {5, 1.99, 0.6}, {5, 2, 0.9}, {4.99, 2.01, 1.2}};
  const auto line = fit_line(pole, NeighbourhoodOptions{});
  ASSERT_TRUE(line);
  EXPECT_GT(std::abs(line->direction.z()), 0.999);
  EXPECT_LT(line_distance_residual(*line, {5, 2, 10}), 0.2);

  const std::vector<Eigen::Vector3d> wall{
      {5, 0, 0}, {5, 1, 0}, {5, 0, 1}, {5, 1, 1}, {5, 0.5, 0.5}};
  EXPECT_FALSE(fit_line(wall, NeighbourhoodOptions{}));
}

TEST(FitLine, RefusesAStripOfAWallAndAThickSet) {
  NeighbourhoodOptions options;
  const std::vector<Eigen::Vector3d> strip{
      {5, 0.1, 0}, {5, -0.1, 0.3}, {5, 0.12, 0.6}, {5, -0.1, 0.9}, {5.001, 0.1, 1.2}};
  EXPECT_FALSE(fit_line(strip, options));
  options.line_flatness = 1e6;
  EXPECT_TRUE(fit_line(strip, options));
  options.line_thickness_m = 0.05;
  EXPECT_FALSE(fit_line(strip, options));
}

TEST(FitPlane, FindsAWallAlsoThroughTheOriginOfTheMap) {
  // The form A n = -1 of published codes has no solution here.
  const std::vector<Eigen::Vector3d> wall{
      {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.01, 1, 1}, {-0.01, 0.5, 0.5}};
  const auto plane = fit_plane(wall, NeighbourhoodOptions{});
  ASSERT_TRUE(plane);
  EXPECT_GT(std::abs(plane->normal.x()), 0.999);
  EXPECT_NEAR(plane_residual(*plane, {0, 3, 3}), 0, 0.05);
}

TEST(FitPlane, RefusesAThickSetAndASingleScanLine) {
  const std::vector<Eigen::Vector3d> thick{
      {0, 0, 0}, {0.5, 1, 0}, {0, 0, 1}, {0.5, 0, 0.5}, {0, 1, 1}};
  NeighbourhoodOptions options;
  EXPECT_FALSE(fit_plane(thick, options));
  const std::vector<Eigen::Vector3d> one_ring{
      {5, 0, 0}, {5, 0.2, 0}, {5, 0.4, 0.001}, {5, 0.6, 0}, {5, 0.8, 0}};
  EXPECT_FALSE(fit_plane(one_ring, options));
}

}  // namespace
}  // namespace traverse::loam
