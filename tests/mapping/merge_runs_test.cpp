#include "traverse/mapping/merge_runs.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/so3.hpp"
#include "traverse/simulation/analytic_scene.hpp"

namespace traverse::mapping {
namespace {

using geometry::Pose3;

/// A street with houses, cars and poles at places that the seed draws.
simulation::AnalyticScene street(unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  simulation::AnalyticScene scene;
  scene.add(simulation::Rectangle{{-40, -30, 0}, {160, 0, 0}, {0, 60, 0}});
  for (double x = -35; x < 110; x += uniform(8, 16)) {
    for (const double side : {-1.0, 1.0}) {
      const double deep = uniform(6, 10);
      scene.add_box({x + uniform(-2, 2), side * (uniform(8, 13) + deep / 2), 0},
                    {uniform(5, 9), deep, uniform(3, 10)}, uniform(-0.2, 0.2), 0.5);
      scene.add_box({x + uniform(-3, 3), side * 6, 0}, {4.5, 1.8, uniform(1.3, 2)}, 0, 0.5);
      scene.add(simulation::Pole{{x + uniform(-4, 4), side * 7, 0}, 0.15, 6});
    }
  }
  return scene;
}

/// Keyframes every 2 m from x = first to last, in a map frame of their own.
std::vector<MapKeyframe> run(const simulation::AnalyticScene& scene, const Pose3& T_world_map,
                             double first, double last, double y) {
  std::vector<MapKeyframe> keyframes;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.02);
  const double sign = last > first ? 1 : -1;
  for (double x = first; sign * (last - x) >= 0; x += 2 * sign) {
    MapKeyframe keyframe;
    keyframe.p_body_sensor = {0.3, 0, 1.8};
    const double heading = (sign > 0 ? 0 : std::numbers::pi) + 0.1 * std::sin(x / 7);
    const Pose3 T_world_body{geometry::exp_so3({0, 0, heading}), {x, y + std::sin(x / 9), 0}};
    keyframe.T_map_body = T_world_map.inverse() * T_world_body;
    const Eigen::Vector3d origin = T_world_body * keyframe.p_body_sensor;
    for (double elevation = -20; elevation <= 12; elevation += 1.5) {
      for (double azimuth = 0; azimuth < 360; azimuth += 1.5) {
        const Eigen::Vector3d u_body(
            std::cos(elevation * geometry::kDegree) * std::cos(azimuth * geometry::kDegree),
            std::cos(elevation * geometry::kDegree) * std::sin(azimuth * geometry::kDegree),
            std::sin(elevation * geometry::kDegree));
        const auto hit = scene.first_hit(origin, T_world_body.rotation * u_body, 60);
        if (!hit) continue;
        const Eigen::Vector3d p =
            keyframe.p_body_sensor + (hit->distance_m + noise(random)) * u_body;
        keyframe.x.push_back(static_cast<float>(p.x()));
        keyframe.y.push_back(static_cast<float>(p.y()));
        keyframe.z.push_back(static_cast<float>(p.z()));
        keyframe.intensity.push_back(0.5F);
      }
    }
    keyframes.push_back(keyframe);
  }
  return keyframes;
}

const Pose3 kFirstFrame{geometry::exp_so3({0, 0, 0.4}), {3, -1, 0}};
const Pose3 kOtherFrame{geometry::exp_so3({0.01, -0.02, 2.1}), {-50, 80, 5}};

MergeOptions quick() {
  MergeOptions options;
  options.samples = 8;
  options.candidates = 3;
  options.search_m = 1.5;
  return options;
}

TEST(MergeRuns, PutsADriveInTheOtherDirectionOntoTheFirst) {
  const auto scene = street(1);
  const MergedRuns merged = merge_runs(
      {run(scene, kFirstFrame, 0, 30, -1.5), run(scene, kOtherFrame, 38, 6, 1.5)}, quick());
  ASSERT_EQ(merged.runs.size(), 2U);
  EXPECT_GE(merged.links.size(), 8U);
  double worst = 0;
  const auto expected = run(scene, kFirstFrame, 38, 6, 1.5);
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const Pose3 difference = expected[k].T_map_body.inverse() * merged.runs[1][k].T_map_body;
    worst = std::max(worst, difference.translation.norm());
  }
  std::printf("%zu links, worst keyframe of the second run off by %.3f m\n", merged.links.size(),
              worst);
  EXPECT_LT(worst, 0.15);
}

TEST(MergeRuns, RefusesRunsOfDifferentPlaces) {
  try {
    merge_runs({run(street(1), kFirstFrame, 0, 30, -1.5), run(street(2), kOtherFrame, 0, 30, 1.5)},
               quick());
    FAIL() << "they were merged";
  } catch (const NoOverlap& error) {
    EXPECT_EQ(error.run(), 1U);
  }
}

}  // namespace
}  // namespace traverse::mapping
