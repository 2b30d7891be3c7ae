#include "probed_path.hpp"

#include <functional>

#include <gtest/gtest.h>

#include "traverse/geometry/so3.hpp"

namespace traverse::app {
namespace {

/// Frames until there is enough, of 1000 at most.
int frames_needed(bool has_others, const std::function<geometry::Pose3(int)>& pose) {
  ProbedPath path;
  int frames = 0;
  while (!path.is_enough(has_others) && frames < 1000) path.add(pose(frames++));
  return frames;
}

geometry::Pose3 pose_at(double x_m, double yaw) {
  return {geometry::exp_so3({0, 0, yaw}), {x_m, 0, 0}};
}

TEST(ProbedPath, GoesOnWhileTheVehicleHasHardlyMovedOrTurned) {
  const auto drives = [](int i) { return pose_at(0.8 * i, 0.031 * i); };
  const auto stands_first = [&](int i) { return drives(i < 100 ? 0 : i - 100); };
  const auto trembles = [](int i) { return pose_at(i % 2 == 0 ? 0 : 0.2, i % 2 == 0 ? 0 : 0.02); };
  const auto goes_straight = [](int i) { return pose_at(0.8 * i, 0); };
  EXPECT_EQ(frames_needed(true, drives), 60);
  EXPECT_EQ(frames_needed(true, stands_first), 150) << "1.5 rad after the start";
  EXPECT_EQ(frames_needed(true, trembles), 300) << "an odometry's noise is no motion";
  EXPECT_EQ(frames_needed(true, goes_straight), 300);
  EXPECT_EQ(frames_needed(false, stands_first), 60) << "there is nothing to hold it against";
}

}  // namespace
}  // namespace traverse::app
