#include "traverse/evaluation/path_figures.hpp"

#include <numbers>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "traverse/geometry/so3.hpp"

#include "geometry/random_motion.hpp"

namespace traverse::evaluation {
namespace {

using geometry::Pose3;

TEST(PathFigures, TheEndErrorCountsFromTheFirstPose) {
  // The estimate starts elsewhere and turned; from its first pose it goes 11 m and ends 1 deg off.
  testing::RandomMotion random(1);
  const Pose3 T_start = random.pose(3, 100);
  const double degree = std::numbers::pi / 180;
  const std::vector<Pose3> reference{{Eigen::Matrix3d::Identity(), {0, 0, 0}},
                                     {Eigen::Matrix3d::Identity(), {4, 0, 0}},
                                     {Eigen::Matrix3d::Identity(), {10, 0, 0}}};
  const std::vector<Pose3> estimate{T_start,
                                    T_start * Pose3{Eigen::Matrix3d::Identity(), {4, 0, 0}},
                                    T_start * Pose3{geometry::exp_so3({0, 0, degree}), {11, 0, 0}}};
  const PathFigures figures = path_figures(estimate, reference);
  EXPECT_NEAR(figures.estimate_m, 11, 1e-12);
  EXPECT_NEAR(figures.reference_m, 10, 1e-12);
  EXPECT_NEAR(figures.end_error_m, 1, 1e-12);
  EXPECT_NEAR(*figures.end_error_percent, 10, 1e-11);
  EXPECT_NEAR(figures.end_rotation_deg, 1, 1e-12);
}

/// A vehicle that stood: half a metre off a reference that wandered by 1.2 m was 40 %.
TEST(PathFigures, ThePercentageOfAShortPathIsNotDefined) {
  const auto off_by = [](double path_m) {
    const Pose3 start;
    const Pose3 end{Eigen::Matrix3d::Identity(), {path_m, 0, 0}};
    const Pose3 estimated{Eigen::Matrix3d::Identity(), {path_m, 0.5, 0}};
    return path_figures(std::vector{start, estimated}, std::vector{start, end});
  };
  EXPECT_FALSE(off_by(1.2).end_error_percent);
  EXPECT_FALSE(off_by(9.9).end_error_percent);
  EXPECT_NEAR(*off_by(20).end_error_percent, 2.5, 1e-9);
  EXPECT_NEAR(off_by(1.2).end_error_m, 0.5, 1e-12);
}

TEST(PathFigures, APercentageOfNoPathIsNotDefined) {
  const std::vector<Pose3> one{Pose3()};
  EXPECT_FALSE(path_figures(one, one).end_error_percent);
  EXPECT_EQ(path_figures(one, one).end_error_m, 0);
  EXPECT_THROW(path_figures({}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::evaluation
