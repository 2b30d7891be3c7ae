#include "traverse/evaluation/error_split.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/evaluation/evaluate.hpp"
#include "traverse/evaluation/table.hpp"
#include "traverse/evaluation/titles.hpp"
#include "traverse/geometry/so3.hpp"

namespace traverse::evaluation {
namespace {

using geometry::Pose3;
using ::testing::HasSubstr;

/// A circle of 30 m radius driven to the left, a pose every half metre; the vehicle looks ahead.
std::vector<Pose3> driven_circle(std::size_t poses) {
  std::vector<Pose3> path;
  for (std::size_t i = 0; i < poses; ++i) {
    const double angle = static_cast<double>(i) / 60;
    Pose3 pose;
    pose.translation = {30 * std::sin(angle), 30 * (1 - std::cos(angle)), 0};
    pose.rotation = geometry::exp_so3(Eigen::Vector3d(0, 0, angle));
    path.push_back(pose);
  }
  return path;
}

/// Each pose moved in its own axes: ahead, left, up.
std::vector<Pose3> moved(std::vector<Pose3> path,
                         const std::function<Eigen::Vector3d(std::size_t)>& by) {
  for (std::size_t i = 0; i < path.size(); ++i) {
    path[i].translation += path[i].rotation * by(i);
  }
  return path;
}

TEST(ErrorSplit, TellsAheadFromLeftFromUp) {
  const auto reference = driven_circle(400);
  const auto estimate =
      moved(reference, [](std::size_t) { return Eigen::Vector3d(0.3, -0.2, 0.1); });
  const auto split = error_split(estimate, reference);
  ASSERT_TRUE(split);
  EXPECT_EQ(split->poses, 400U);
  EXPECT_NEAR(split->along.mean_m, 0.3, 1e-2);
  EXPECT_NEAR(split->across.mean_m, -0.2, 1e-2);
  EXPECT_NEAR(split->up.mean_m, 0.1, 1e-9);
  EXPECT_NEAR(split->across.rmse_m, 0.2, 1e-2);
  EXPECT_NEAR(split->across.max_m, 0.2, 3e-2);
}

/// The three together are the whole error, in whatever direction it lies.
TEST(ErrorSplit, LosesNothing) {
  const auto reference = driven_circle(300);
  const auto estimate = moved(reference, [](std::size_t i) {
    const auto k = static_cast<double>(i);
    return Eigen::Vector3d(0.3 * std::sin(k), 0.1 * std::cos(3 * k), 0.2 * std::sin(0.1 * k));
  });
  const auto split = error_split(estimate, reference);
  double squares = 0;
  for (std::size_t i = 0; i < 300; ++i) {
    squares += (estimate[i].translation - reference[i].translation).squaredNorm();
  }
  EXPECT_NEAR(std::hypot(split->along.rmse_m, split->across.rmse_m, split->up.rmse_m),
              std::sqrt(squares / 300), 1e-9);
}

TEST(ErrorSplit, OfACamerasAxesUpIsUpToo) {
  // x right, y down, z ahead: the body's axes of the KITTI benchmark, and its map's.
  Pose3 T_camera_body;
  T_camera_body.rotation << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  const auto as_camera = [&](std::vector<Pose3> path) {
    for (Pose3& pose : path) pose = T_camera_body * pose * T_camera_body.inverse();
    return path;
  };
  const auto reference = driven_circle(300);
  const auto estimate =
      moved(reference, [](std::size_t) { return Eigen::Vector3d(0.3, 0.2, 0.1); });
  const auto split = error_split(as_camera(estimate), as_camera(reference));
  EXPECT_NEAR(split->along.mean_m, 0.3, 1e-2);
  EXPECT_NEAR(split->across.mean_m, 0.2, 1e-2);
  EXPECT_NEAR(split->up.mean_m, 0.1, 1e-9);
}

TEST(ErrorSplit, StandingPosesHaveTheDirectionOfTheWayToThemAndNoneIfThereIsNone) {
  std::vector<Pose3> reference = driven_circle(50);
  const Pose3 last = reference.back();
  reference.insert(reference.end(), 100, last);
  EXPECT_EQ(error_split(reference, reference)->poses, 150U);
  EXPECT_FALSE(error_split(std::vector<Pose3>(50), std::vector<Pose3>(50)));
}

TEST(ErrorSplit, ATurnOnTheSpotAndBackHasDirections) {
  std::vector<Pose3> reference;
  for (int i = 0; i <= 40; ++i) {
    Pose3 pose;
    pose.translation.x() = i <= 20 ? 0.5 * i : 0.5 * (40 - i);
    reference.push_back(pose);
  }
  const auto estimate = moved(reference, [](std::size_t) { return Eigen::Vector3d(0.1, 0, 0); });
  const auto split = error_split(estimate, reference);
  ASSERT_TRUE(split);
  EXPECT_NEAR(split->along.max_m, 0.1, 1e-9);  // ahead on the way there, behind on the way back
  EXPECT_NEAR(split->along.mean_m, 0, 0.01);
  EXPECT_NEAR(split->across.max_m, 0, 1e-9);
}

/// What jitter is found of errors along the path, of a standard deviation of 0.05 m.
double alternating_of(const std::function<double(std::size_t)>& along) {
  const auto reference = driven_circle(2000);
  const auto estimate =
      moved(reference, [&](std::size_t i) { return Eigen::Vector3d(along(i), 0, 0); });
  return error_split(estimate, reference)->alternating_m.value();
}

double white(std::size_t i) {  // of variance 1
  auto x = static_cast<std::uint64_t>(i + 1) * 0x9E3779B97F4A7C15U;
  x ^= x >> 31U;
  x *= 0xBF58476D1CE4E5B9U;
  x ^= x >> 29U;
  return std::sqrt(12.0) * (static_cast<double>(x >> 11U) / static_cast<double>(1ULL << 53U) - 0.5);
}

TEST(ErrorSplit, TellsJitterFromDrift) {
  const auto strict = [](std::size_t i) { return i % 2 == 0 ? 0.05 : -0.05; };
  const auto drift = [](std::size_t i) { return 0.5 * std::sin(static_cast<double>(i) / 300); };
  EXPECT_NEAR(alternating_of(strict), 0.05, 2e-3);
  EXPECT_NEAR(alternating_of([](std::size_t i) { return 0.05 * white(i); }), 0.05, 4e-3);
  EXPECT_NEAR(alternating_of([&](std::size_t i) { return drift(i) + 0.05 * white(i); }), 0.05,
              4e-3);
  EXPECT_LT(alternating_of(drift), 1e-4);
  double walk = 0;  // each frame errs by itself, and keeps what it erred
  EXPECT_LT(alternating_of([&](std::size_t i) { return walk += 0.01 * white(i); }), 0.003);
}

Evaluation evaluation_of(const std::function<double(std::size_t)>& along) {
  geometry::Trajectory reference;
  geometry::Trajectory estimate;
  const auto path = driven_circle(400);
  const auto off = moved(path, [&](std::size_t i) { return Eigen::Vector3d(along(i), 0, 0); });
  for (std::size_t i = 0; i < path.size(); ++i) {
    const auto stamp = geometry::Stamp::from_seconds(0.1 * static_cast<double>(i));
    reference.push_back(stamp, path[i]);
    estimate.push_back(stamp, off[i]);
  }
  return evaluate(estimate, reference, run_evaluation_options());
}

TEST(ErrorSplit, IsToldByEvaluateWithANoteWhereTheErrorAlternates) {
  const Evaluation jitter = evaluation_of([](std::size_t i) { return 0.05 * white(i); });
  EXPECT_THAT(to_table(jitter), HasSubstr("along, across and up the path"));
  EXPECT_THAT(to_table(jitter), HasSubstr("from frame to frame and back"));
  const Evaluation drift =
      evaluation_of([](std::size_t i) { return 0.5 * std::sin(static_cast<double>(i) / 40); });
  EXPECT_THAT(to_table(drift), HasSubstr("along [m]"));
  EXPECT_EQ(alternation_note(*drift.comparison), "");
}

}  // namespace
}  // namespace traverse::evaluation
