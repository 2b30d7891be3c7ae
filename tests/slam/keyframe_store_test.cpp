#include "traverse/slam/keyframe_store.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

#include "traverse/slam/keyframe_file.hpp"

#include "temporary_folder.hpp"

namespace traverse::slam {
namespace {

Keyframe made(std::size_t id) {
  Keyframe keyframe;
  keyframe.id = id;
  keyframe.stamp = {static_cast<std::int64_t>(id) * 1'000'000'000};
  keyframe.T_odom_lidar.translation = {static_cast<double>(id), 1, 2};
  keyframe.step_covariance = geometry::Matrix6::Identity() * 0.25;
  keyframe.health.line_matches = 7;
  for (int i = 0; i < 100; ++i) {
    const auto value = static_cast<float>(id) + 0.01F * static_cast<float>(i);
    keyframe.points.x.push_back(value);
    keyframe.points.y.push_back(-value);
    keyframe.points.z.push_back(3);
    keyframe.points.intensity.push_back(0.5F);
    keyframe.points.ring.push_back(static_cast<std::uint16_t>(i));
    keyframe.features.surface.push_back(value, 1, 2, value, 5);
    keyframe.features.planar.push_back(value, 3, 2, value, 5);
    keyframe.features.edges.push_back(1, value, 2, value, 6);
  }
  keyframe.features.surface.time.resize(100);
  keyframe.features.planar.time.resize(100);
  keyframe.features.edges.time.resize(100);
  keyframe.features.surface_is_planar.assign(100, 1);
  return keyframe;
}

TEST(KeyframeStore, WhatIsSpilledComesBackTheSame) {
  const std::size_t one = bytes_of(made(0));
  KeyframeStore store(3 * one);
  for (std::size_t id = 0; id < 10; ++id) store.add(made(id));
  EXPECT_EQ(store.spilled(), 7U);
  EXPECT_LE(store.resident_bytes(), 3 * one);
  const KeyframeStore copy = store;
  for (std::size_t id = 0; id < 10; ++id) {
    const auto keyframe = copy.at(id);
    const Keyframe expected = made(id);
    EXPECT_EQ(keyframe->id, id);
    EXPECT_EQ(keyframe->stamp, expected.stamp);
    EXPECT_EQ(keyframe->points.x, expected.points.x);
    EXPECT_EQ(keyframe->points.intensity, expected.points.intensity);
    EXPECT_EQ(keyframe->points.ring, expected.points.ring);
    EXPECT_EQ(keyframe->features.surface.x, expected.features.surface.x);
    EXPECT_EQ(keyframe->features.edges.y, expected.features.edges.y);
    EXPECT_EQ(keyframe->T_odom_lidar.translation, expected.T_odom_lidar.translation);
    EXPECT_EQ(keyframe->step_covariance, expected.step_covariance);
    EXPECT_EQ(keyframe->health.line_matches, 7U);
  }
  EXPECT_THROW(store.add(made(3)), std::invalid_argument);
}

TEST(KeyframeFile, ASimpleMapHoldsPointsFeaturesAndPose) {
  const testing::TemporaryFolder folder;
  KeyframeStore store(1'000'000);
  for (std::size_t id = 0; id < 3; ++id) store.add(made(id));
  const auto pose = [](std::size_t id) {
    geometry::Pose3 T;
    T.translation = {10.0 * static_cast<double>(id), 0.5, 0.25};
    return T;
  };
  write_keyframes(folder / "keyframes.simplemap", store, pose);
  const auto read = read_keyframes(folder / "keyframes.simplemap");
  ASSERT_EQ(read.size(), 3U);
  EXPECT_EQ(read[2].stamp, made(2).stamp);
  EXPECT_TRUE(read[2].T_map_lidar.translation.isApprox(Eigen::Vector3d(20, 0.5, 0.25)));
  EXPECT_EQ(read[2].content.points.x, made(2).points.x);
  EXPECT_EQ(read[2].content.features.surface.x, made(2).features.surface.x);
  EXPECT_EQ(read[2].content.features.planar.x, made(2).features.planar.x);
  EXPECT_EQ(read[2].content.features.edges.y, made(2).features.edges.y);
}

}  // namespace
}  // namespace traverse::slam
