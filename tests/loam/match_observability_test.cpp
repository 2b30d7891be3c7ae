#include "match_observability.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "geometry/random_motion.hpp"
#include "point_motion.hpp"

namespace traverse::loam {
namespace {

using testing::RandomMotion;

constexpr double kLeast = 0.005;

/// Matches with random points and the given plane normals in turn.
Matches planes_with_normals(const std::vector<Eigen::Vector3d>& normals) {
  RandomMotion random(1);
  Matches matches;
  for (std::uint32_t i = 0; i < 300; ++i) {
    matches.planes.push_back({i, random.vector(20), Plane{normals[i % normals.size()], 0}});
  }
  return matches;
}

TEST(Observability, ThreeAxesOfNormalsDetermineEverything) {
  const auto result = observability(planes_with_normals({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}),
                                    geometry::Pose3::identity(), kLeast);
  EXPECT_EQ(result.degenerate, 0);
  EXPECT_GT(result.eigenvalues[0], 0.05);
}

TEST(Observability, ATunnelIsDegenerateAlongItsAxisInTheBodyFrame) {
  RandomMotion random(2);
  const geometry::Pose3 pose = random.pose(3, 10);
  const auto result = observability(planes_with_normals({{0, 1, 0}, {0, 0, 1}}), pose, kLeast);
  ASSERT_EQ(result.degenerate, 1);
  const Eigen::Vector3d axis_lidar = pose.rotation.transpose() * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(std::abs(result.directions.col(0).tail<3>().dot(axis_lidar)), 1, 1e-9);
  EXPECT_NEAR(result.directions.col(0).head<3>().norm(), 0, 1e-9);
}

TEST(Observability, ALineDeterminesTheTwoDirectionsAcrossIt) {
  RandomMotion random(3);
  Matches matches;
  for (std::uint32_t i = 0; i < 100; ++i) {
    matches.lines.push_back({i, random.vector(20), Line{random.vector(20), {0, 0, 1}}});
  }
  const auto result = observability(matches, geometry::Pose3::identity(), kLeast);
  ASSERT_EQ(result.degenerate, 1);
  EXPECT_NEAR(std::abs(result.directions(5, 0)), 1, 1e-9) << "along the poles";
}

TEST(Observability, TheDegeneratePartOfAStepIsRemovedAndOnlyThat) {
  const auto result = observability(planes_with_normals({{0, 1, 0}, {0, 0, 1}}),
                                    geometry::Pose3::identity(), kLeast);
  geometry::Twist step;
  step << 0.01, -0.02, 0.03, 1, 2, 3;
  geometry::Twist expected = step;
  expected[3] = 0;
  EXPECT_LT((result.well_observed(step) - expected).norm(), 1e-9);
}

TEST(Observability, APointThatSawPartOfTheSweepCountsWithThatPart) {
  // The information from differences of n . q along the twist, with the part of the motion.
  RandomMotion random(4);
  const geometry::Pose3 pose = random.pose(0.5, 2);
  Matches matches = planes_with_normals({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  for (PlaneMatch& match : matches.planes) match.fraction = random.uniform(0, 1);
  const auto result = observability(matches, pose, kLeast);

  lidar::Matrix6 information = lidar::Matrix6::Zero();
  constexpr double kStep = 1e-6;
  for (const PlaneMatch& match : matches.planes) {
    const auto distance = [&](const geometry::Twist& twist) {
      const geometry::Pose3 moved = part_of(pose * geometry::exp_se3(twist), match.fraction);
      return match.plane.normal.dot(moved * match.p_lidar);
    };
    lidar::Vector6 row;
    for (int k = 0; k < 6; ++k) {
      const geometry::Twist step = kStep * geometry::Twist::Unit(k);
      row[k] = (distance(step) - distance(-step)) / (2 * kStep);
    }
    row.head<3>() /= result.rotation_scale_m;
    information += row * row.transpose() / static_cast<double>(matches.size());
  }
  const lidar::Vector6 expected =
      Eigen::SelfAdjointEigenSolver<lidar::Matrix6>(information).eigenvalues();
  EXPECT_LT((result.eigenvalues - expected).norm(), 1e-7);
  for (PlaneMatch& match : matches.planes) match.fraction = 0;
  EXPECT_EQ(observability(matches, pose, kLeast).degenerate, 6) << "points that saw no motion";
}

TEST(Observability, WithoutMatchesNothingIsDetermined) {
  const auto result = observability(Matches{}, geometry::Pose3::identity(), kLeast);
  EXPECT_EQ(result.degenerate, 6);
  EXPECT_EQ(result.well_observed(geometry::Twist::Ones()).norm(), 0);
}

}  // namespace
}  // namespace traverse::loam
