#include "traverse/replay/map_history.hpp"

#include <random>

#include <gtest/gtest.h>

namespace traverse::replay {
namespace {

std::vector<Eigen::Vector3f> cloud(std::size_t count, float centre_x, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> offset(-50, 50);
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(centre_x + offset(random), offset(random), 0.1F * offset(random));
  }
  return points;
}

TEST(MapHistory, APrefixIsTheMapAsItWas) {
  MapHistory map(0.5, 1'000'000);
  MapHistory shorter(0.5, 1'000'000);
  for (unsigned frame = 0; frame < 6; ++frame) {
    map.add_frame(cloud(3000, 20.0F * static_cast<float>(frame), frame), {});
    if (frame < 3) shorter.add_frame(cloud(3000, 20.0F * static_cast<float>(frame), frame), {});
  }
  EXPECT_EQ(map.size_at(3), shorter.points().size());
  EXPECT_EQ(map.size_at(0), 0U);
  EXPECT_EQ(map.size_at(100), map.points().size());
  const ChosenPoints a = map.choose(3, {10, 0, 0}, 2000);
  const ChosenPoints b = shorter.choose(3, {10, 0, 0}, 2000);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.of, b.of);
}

TEST(MapHistory, KeepsOnePointAVoxel) {
  MapHistory map(1, 1000);
  map.add_frame(std::vector<Eigen::Vector3f>{{0.1F, 0.1F, 0.1F}, {0.2F, 0.3F, 0.4F}, {1.5F, 0, 0}},
                std::vector<float>{0.3F, 0.6F, 0.9F});
  ASSERT_EQ(map.points().size(), 2U);
  EXPECT_EQ(map.intensities(), (std::vector<float>{0.3F, 0.9F}));
}

TEST(MapHistory, DrawsNoMoreThanTheBudgetAndMostNearTheFocus) {
  MapHistory map(0.1, 10'000'000);
  for (unsigned frame = 0; frame < 10; ++frame) {
    map.add_frame(cloud(30000, 100.0F * static_cast<float>(frame), frame), {});
  }
  const Eigen::Vector3f focus(0, 0, 0);
  const ChosenPoints chosen = map.choose(10, focus, 20000);
  EXPECT_LE(chosen.points.size(), 20000U);
  EXPECT_GE(chosen.points.size(), 18000U);
  const auto share_within = [&](float near, float far) {
    const auto inside = [&](const Eigen::Vector3f& p) {
      const float d = (p - focus).norm();
      return d >= near && d < far;
    };
    return static_cast<double>(std::count_if(chosen.points.begin(), chosen.points.end(), inside)) /
           static_cast<double>(std::count_if(map.points().begin(), map.points().end(), inside));
  };
  const double nearest = share_within(0, 20);
  const double middle = share_within(60, 120);
  const double farthest = share_within(400, 800);
  EXPECT_GT(nearest, 0.9);
  EXPECT_GT(nearest, 4 * middle);
  EXPECT_GT(middle, 4 * farthest);
  EXPECT_GT(farthest, 0);
  EXPECT_EQ(map.choose(10, focus, 10'000'000).points.size(), map.points().size());
}

TEST(MapHistory, ThinsItselfWhenThereIsTooMuch) {
  MapHistory map(0.1, 20'000);
  for (unsigned frame = 0; frame < 10; ++frame) map.add_frame(cloud(5000, 0, frame), {});
  EXPECT_LE(map.points().size(), 20'000U);
  EXPECT_GT(map.voxel_m(), 0.1);
  for (std::size_t frame = 1; frame < 10; ++frame) {
    EXPECT_LE(map.size_at(frame), map.size_at(frame + 1));
  }
  EXPECT_EQ(map.size_at(10), map.points().size());
}

}  // namespace
}  // namespace traverse::replay
