#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include <gtest/gtest.h>

#include "traverse/lidar/odometry.hpp"

namespace traverse::testing {

/// What an odometry shows of its last frame belongs together: as many matches as the health record
/// counts, their feet where direction and residual say, under the pose, and points of the map
/// nearer than `within_m` to them.
inline void expect_consistent_view(const lidar::Odometry& odometry, const lidar::Frame& frame,
                                   double within_m) {
  using Kind = lidar::MatchedPoint::Kind;
  std::size_t lines = 0;
  std::size_t planes = 0;
  double squares = 0;
  for (const auto& match : odometry.matches()) {
    (match.kind == Kind::kLine ? lines : planes) += 1;
    const Eigen::Vector3d from_foot = match.p_map - match.foot_map;
    EXPECT_NEAR(match.direction.norm(), 1, 1e-6);
    const double along = match.direction.dot(from_foot);
    EXPECT_NEAR(along, match.kind == Kind::kLine ? 0 : match.residual_m, 2e-5);
    EXPECT_NEAR(from_foot.norm(), std::abs(match.residual_m), 2e-5);
    squares += match.residual_m * match.residual_m;
  }
  EXPECT_EQ(lines, frame.health.line_matches);
  EXPECT_EQ(planes, frame.health.plane_matches);
  const double rms = std::sqrt(squares / static_cast<double>(lines + planes));
  EXPECT_NEAR(rms, frame.health.residual_rms_m, 0.1 * frame.health.residual_rms_m);

  const auto map = odometry.local_map();
  const auto matches = odometry.matches();
  EXPECT_GT(map.size(), 1000U);
  for (std::size_t i = 0; i < matches.size(); i += 50) {
    double nearest_m = 1e9;
    for (const Eigen::Vector3d& p : map) {
      nearest_m = std::min(nearest_m, (p - matches[i].foot_map).norm());
    }
    EXPECT_LT(nearest_m, within_m) << "what match " << i << " was registered on";
  }
}

}  // namespace traverse::testing
