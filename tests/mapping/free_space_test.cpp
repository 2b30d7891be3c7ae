#include "traverse/mapping/free_space.hpp"

#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "traverse/geometry/angle.hpp"
#include "traverse/simulation/analytic_scene.hpp"

namespace traverse::mapping {
namespace {

using simulation::AnalyticScene;

/// A street: road, a facade on either side, poles; and what stands in it for a moment.
AnalyticScene street() {
  AnalyticScene scene;
  scene.add(simulation::Rectangle{{-60, -8, 0}, {160, 0, 0}, {0, 16, 0}});
  scene.add(simulation::Rectangle{{-60, -8, 0}, {160, 0, 0}, {0, 0, 8}});
  scene.add(simulation::Rectangle{{-60, 8, 0}, {160, 0, 0}, {0, 0, 8}});
  scene.add_box({20, -6.5, 0}, {4.5, 1.8, 1.5}, 0, 0.5);  // parked
  for (int k = -3; k < 6; ++k) scene.add(simulation::Pole{{10.0 * k, 7, 0}, 0.1, 5});
  return scene;
}

struct LabelledKeyframes {
  std::vector<MapKeyframe> keyframes;
  std::vector<std::vector<char>> is_moving;  ///< one a point
};

/// A drive along the street; a car comes the other way at 10 m/s, another one drives ahead at the
/// vehicle's own speed, a keyframe every 2 m and 0.2 s.
LabelledKeyframes drive() {
  const AnalyticScene standing = street();
  const Eigen::Vector3d p_body_sensor(0.5, 0, 1.8);
  LabelledKeyframes result;
  for (int k = 0; k < 16; ++k) {
    const double t = 0.2 * k;
    AnalyticScene moving;
    moving.add_box({45 - 10 * t, 2.5, 0.25}, {4.5, 1.8, 1.4}, 0, 0.5);
    moving.add_box({12 + 10 * t, -2.5, 0.25}, {4.5, 1.8, 1.4}, 0, 0.5);
    MapKeyframe keyframe;
    keyframe.T_map_body.translation = {2.0 * k, -2.5, 0};
    keyframe.p_body_sensor = p_body_sensor;
    std::vector<char>& is_moving = result.is_moving.emplace_back();
    const Eigen::Vector3d origin = keyframe.T_map_body * p_body_sensor;
    for (double elevation = -24; elevation <= 6; elevation += 1) {
      for (double azimuth = 0; azimuth < 360; azimuth += 1) {
        const double a = (azimuth + 0.37 * k) * geometry::kDegree;
        const double e = elevation * geometry::kDegree;
        const Eigen::Vector3d u(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
        const auto still = standing.first_hit(origin, u, 60);
        const auto passing = moving.first_hit(origin, u, still ? still->distance_m : 60);
        if (!still && !passing) continue;
        const double range = passing ? passing->distance_m : still->distance_m;
        const Eigen::Vector3d p = keyframe.T_map_body.inverse() * (origin + range * u);
        keyframe.x.push_back(static_cast<float>(p.x()));
        keyframe.y.push_back(static_cast<float>(p.y()));
        keyframe.z.push_back(static_cast<float>(p.z()));
        is_moving.push_back(passing ? 1 : 0);
      }
    }
    result.keyframes.push_back(keyframe);
  }
  return result;
}

struct Shares {
  double moving = 0;    ///< of the points on moving objects that are in free space
  double standing = 0;  ///< of the others
};

Shares free_shares(const LabelledKeyframes& drive, const FreeSpaceOptions& options) {
  const FreeSpace free_space(drive.keyframes, options);
  double points[2] = {0, 0}, free[2] = {0, 0};
  for (std::size_t k = 0; k < drive.keyframes.size(); ++k) {
    const MapKeyframe& keyframe = drive.keyframes[k];
    for (std::size_t i = 0; i < keyframe.size(); ++i) {
      const int kind = drive.is_moving[k][i] != 0 ? 1 : 0;
      points[kind] += 1;
      if (free_space.is_free(keyframe.T_map_body * keyframe.p_body(i))) free[kind] += 1;
    }
  }
  return {free[1] / points[1], free[0] / points[0]};
}

TEST(FreeSpace, TakesMovingVehiclesAndLeavesTheStreet) {
  const Shares shares = free_shares(drive(), {});
  std::printf("free: %.2f %% of the points on vehicles, %.3f %% of the others\n",
              100 * shares.moving, 100 * shares.standing);
  EXPECT_GT(shares.moving, 0.9);
  EXPECT_LT(shares.standing, 1e-4);  // four times as many without regard to incidence
}

TEST(FreeSpace, WithoutMovementNothingIsFree) {
  LabelledKeyframes still = drive();
  for (std::size_t k = 0; k < still.keyframes.size(); ++k) {
    std::vector<char> keep;
    for (const char moving : still.is_moving[k]) keep.push_back(moving != 0 ? 0 : 1);
    still.keyframes[k].keep_only(keep);
  }
  const FreeSpace free_space(still.keyframes, {});
  EXPECT_LT(static_cast<double>(free_space.free_cubes()),
            0.005 * static_cast<double>(free_space.cubes()));
}

TEST(FreeSpace, RemovesItsPointsFromKeyframes) {
  LabelledKeyframes labelled = drive();
  const FreeSpace free_space(labelled.keyframes, {});
  std::size_t before = 0, after = 0;
  for (const auto& keyframe : labelled.keyframes) before += keyframe.size();
  const std::size_t removed = remove_free_points(free_space, labelled.keyframes);
  for (const auto& keyframe : labelled.keyframes) {
    after += keyframe.size();
    for (std::size_t i = 0; i < keyframe.size(); ++i) {
      ASSERT_FALSE(free_space.is_free(keyframe.T_map_body * keyframe.p_body(i)));
    }
  }
  EXPECT_GT(removed, 0U);
  EXPECT_EQ(before - after, removed);
}

}  // namespace
}  // namespace traverse::mapping
