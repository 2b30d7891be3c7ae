#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "pose_graph/made_drive.hpp"

namespace traverse::pose_graph {
namespace {

using geometry::Pose3;
using testing::MadeDrive;
using testing::MadeDriveOptions;
using testing::Noise;

constexpr double kDegree = 3.14159265358979 / 180;

MadeDrive short_drive(unsigned seed) {
  MadeDriveOptions options;
  options.keyframes_a_lap = 60;
  options.loops = 20;
  options.false_share = 0;
  return testing::made_drive(options, seed);
}

TEST(PoseGraph, WithoutLoopsIsOdometry) {
  const MadeDrive drive = short_drive(1);
  PoseGraph graph = testing::odometry_graph(drive);
  const Result result = graph.optimise();
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.reason, optimization::Termination::kConverged);
  EXPECT_EQ(result.loops, 0U);
  for (std::size_t k = 0; k < drive.odometry.size(); ++k) {
    EXPECT_LT(geometry::log_se3(drive.odometry[k].inverse() * graph.pose(k)).norm(), 1e-9);
  }
}

TEST(PoseGraph, LoopsWithoutNoiseBringEveryPoseToTheTruth) {
  MadeDrive drive = short_drive(2);
  for (std::size_t k = 1; k < drive.truth.size(); ++k) {  // guesses drift, measurements do not
    drive.steps[k - 1] = drive.truth[k - 1].inverse() * drive.truth[k];
  }
  for (auto& loop : drive.loops) loop.T_i_j = drive.truth[loop.i].inverse() * drive.truth[loop.j];
  PoseGraph graph = testing::odometry_graph(drive);
  testing::add_loops(graph, drive, drive.loops);
  EXPECT_GT(testing::position_rmse(graph, drive), 0.1);
  const Result result = graph.optimise();
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.loops, drive.loops.size());
  EXPECT_EQ(result.rejected_loops, 0U);
  EXPECT_LT(testing::position_rmse(graph, drive), 1e-6);
  EXPECT_LT(result.final_cost, 1e-6);
}

/// With honest covariances the sum of chi-squares is that of its degrees of freedom: 6 an edge
/// less 6 a free pose.
TEST(PoseGraph, ChiSquareIsThatOfTheNoise) {
  double sum = 0;
  double freedom = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const MadeDrive drive = short_drive(seed);
    PoseGraph graph = testing::odometry_graph(drive);
    testing::add_loops(graph, drive, drive.loops);
    graph.optimise();
    for (const Edge& edge : graph.edges()) sum += edge.chi2;
    freedom += 6.0 * static_cast<double>(graph.edges().size() - (graph.size() - 1));
  }
  EXPECT_NEAR(sum / freedom, 1, 0.12);  // three sigmas of 1200 degrees of freedom
}

TEST(PoseGraph, TheSameBitsOnEveryRepeat) {
  const MadeDrive drive = short_drive(3);
  PoseGraph one = testing::odometry_graph(drive);
  testing::add_loops(one, drive, drive.loops);
  PoseGraph other = one;
  one.optimise();
  other.optimise();
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one.pose(k).matrix(), other.pose(k).matrix());
  }
}

TEST(PoseGraph, NewNodesGoOnFromTheSolution) {
  const MadeDrive drive = short_drive(4);
  PoseGraph graph = testing::odometry_graph(drive);
  testing::add_loops(graph, drive, drive.loops);
  graph.optimise();
  const std::size_t last = drive.truth.size() - 1;
  const Pose3 step{geometry::exp_so3({0, 0, 0.1}), {2, 0, 0}};
  graph.add_node(last + 1, drive.odometry[last] * step);
  graph.add_between(last, last + 1, step, drive.step_covariance, EdgeKind::kOdometry);
  const Pose3 placed = graph.pose(last).inverse() * graph.pose(last + 1);
  EXPECT_LT(geometry::log_se3(step.inverse() * placed).norm(), 1e-12);
}

TEST(PoseGraph, SolvedLoopByLoopIsTheGraphSolvedAtOnce) {
  const MadeDrive drive = short_drive(5);
  PoseGraph at_once = testing::odometry_graph(drive);
  PoseGraph loop_by_loop = at_once;
  testing::add_loops(at_once, drive, drive.loops);
  at_once.optimise();
  for (const auto& loop : drive.loops) {
    testing::add_loops(loop_by_loop, drive, {loop});
    loop_by_loop.optimise();
  }
  for (std::size_t k = 0; k < at_once.size(); ++k) {
    EXPECT_LT((at_once.pose(k).translation - loop_by_loop.pose(k).translation).norm(), 1e-3) << k;
  }
}

TEST(PoseGraph, SolvedFromTheGuessesForgetsWhatWasSolvedBefore) {
  const MadeDrive drive = short_drive(5);
  PoseGraph at_once = testing::odometry_graph(drive);
  PoseGraph loop_by_loop = at_once;
  testing::add_loops(at_once, drive, drive.loops);
  at_once.optimise();
  for (const auto& loop : drive.loops) {
    testing::add_loops(loop_by_loop, drive, {loop});
    loop_by_loop.optimise();
  }
  loop_by_loop.optimise(Start::kGuesses);
  for (std::size_t k = 0; k < at_once.size(); ++k) {
    EXPECT_EQ(at_once.pose(k).matrix(), loop_by_loop.pose(k).matrix());
  }
}

/// Fixes of every fifth node's antenna in an ENU frame turned by 130 degrees.
struct GnssDrive {
  Pose3 T_enu_map;
  Eigen::Vector3d lever{0.4, -0.3, 1.5};
  double sigma_m = 0.3;

  void add_fixes(PoseGraph& graph, const MadeDrive& drive, Noise& noise) const {
    for (std::size_t k = 0; k < drive.truth.size(); k += 5) {
      graph.add_gnss(k, T_enu_map * (drive.truth[k] * lever) + noise.normal(sigma_m),
                     sigma_m * sigma_m * Eigen::Matrix3d::Identity(), lever);
    }
  }
  double position_rmse(const PoseGraph& graph, const MadeDrive& drive) const {
    double sum = 0;
    for (std::size_t k = 0; k < drive.truth.size(); ++k) {
      sum += (graph.pose(k).translation - (T_enu_map * drive.truth[k]).translation).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(drive.truth.size()));
  }
};

GnssDrive gnss_drive() {
  return {{geometry::exp_so3({0.02, -0.03, 130 * kDegree}), {500, -300, 40}}};
}

TEST(PoseGraph, FixesTurnTheMapIntoEnu) {
  const MadeDrive drive = short_drive(6);
  const GnssDrive gnss = gnss_drive();
  Noise noise(1);
  PoseGraph graph = testing::odometry_graph(drive);
  gnss.add_fixes(graph, drive, noise);
  const Result result = graph.optimise();
  EXPECT_TRUE(result.converged);
  EXPECT_TRUE(result.is_georeferenced);
  EXPECT_EQ(result.fixes, 24U);
  EXPECT_EQ(result.rejected_fixes, 0U);
  EXPECT_LT(gnss.position_rmse(graph, drive), 0.3);
  EXPECT_EQ(*graph.up_map(), Eigen::Vector3d::UnitZ());
}

TEST(PoseGraph, TheLeverArmMatters) {
  const MadeDrive drive = short_drive(6);
  const GnssDrive gnss = gnss_drive();
  Noise noise(1), same_noise(1);
  PoseGraph graph = testing::odometry_graph(drive);
  PoseGraph without = graph;
  gnss.add_fixes(graph, drive, noise);
  for (std::size_t k = 0; k < drive.truth.size(); k += 5) {
    without.add_gnss(
        k, gnss.T_enu_map * (drive.truth[k] * gnss.lever) + same_noise.normal(gnss.sigma_m),
        gnss.sigma_m * gnss.sigma_m * Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
  }
  graph.optimise();
  without.optimise();
  EXPECT_GT(gnss.position_rmse(without, drive), gnss.position_rmse(graph, drive) + 1);
}

TEST(PoseGraph, AFixThatIsFarOffIsRejected) {
  const MadeDrive drive = short_drive(7);
  const GnssDrive gnss = gnss_drive();
  Noise noise(2);
  PoseGraph graph = testing::odometry_graph(drive);
  gnss.add_fixes(graph, drive, noise);
  const Eigen::Vector3d reflected =
      gnss.T_enu_map * drive.truth[32].translation + Eigen::Vector3d(25, -10, 8);
  graph.add_gnss(32, reflected, 0.09 * Eigen::Matrix3d::Identity(), gnss.lever);
  const Result result = graph.optimise();
  EXPECT_EQ(result.rejected_fixes, 1U);
  EXPECT_TRUE(graph.fixes().back().is_rejected());
  EXPECT_LT(gnss.position_rmse(graph, drive), 0.3);
}

TEST(PoseGraph, FixesOfOnePlaceDoNotOrientTheMap) {
  const MadeDrive drive = short_drive(8);
  PoseGraph graph = testing::odometry_graph(drive);
  for (std::size_t k = 0; k < 2; ++k) {  // two metres apart, known to 0.3 m
    graph.add_gnss(k, Eigen::Vector3d(100, 200, 0) + drive.truth[k].translation,
                   0.09 * Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
  }
  EXPECT_FALSE(graph.optimise().is_georeferenced);
  EXPECT_FALSE(graph.up_map());
  EXPECT_EQ(graph.pose(0).matrix(), drive.odometry[0].matrix());
  EXPECT_EQ(graph.fixes()[0].weight, 0);
}

TEST(PoseGraph, GravityLevelsTheWayAndTellsHowTheMapIsTilted) {
  const MadeDrive drive = short_drive(9);
  PoseGraph graph = testing::odometry_graph(drive);
  const PoseGraph odometry = graph;
  Noise noise(3);
  const Eigen::Vector3d up = Eigen::Vector3d(0.05, -0.08, 1).normalized();  // in the first frame
  const double sigma = 0.001;
  for (std::size_t k = 0; k < drive.truth.size(); ++k) {
    graph.add_gravity(k, 9.8 * (drive.truth[k].rotation.transpose() * up) + noise.normal(0.01),
                      sigma);
  }
  const Result result = graph.optimise();
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(graph.pose(0).matrix(), Eigen::Matrix4d::Identity());  // the frame stays
  EXPECT_LT(std::acos(graph.up_map()->dot(up)), 2 * sigma);
  const auto tilt = [&](const PoseGraph& of) {  // of the last pose
    const std::size_t k = drive.truth.size() - 1;
    const Eigen::Vector3d seen = of.pose(k).rotation.transpose() * up;
    return std::acos(seen.dot(drive.truth[k].rotation.transpose() * up));
  };
  EXPECT_GT(tilt(odometry), 0.005);
  EXPECT_LT(tilt(graph), 2 * sigma);
}

/// Laps, in which the body looks every way: what its instrument is off by does not turn with up.
TEST(PoseGraph, WhatAllUpsAreOffByIsFound) {
  MadeDriveOptions steady;
  steady.keyframes_a_lap = 60;
  steady.step_sigma_rad = 5e-5;
  const MadeDrive drive = testing::made_drive(steady, 9);
  const Eigen::Vector3d up = Eigen::Vector3d(0.05, -0.08, 1).normalized();
  const Eigen::Vector3d offset(0.006, -0.004, 0);
  const double sigma = 0.001;
  const auto levelled = [&](double offset_deg) {
    GraphOptions options;
    options.up_offset_deg = offset_deg;
    PoseGraph graph = testing::odometry_graph(drive, options);
    Noise noise(3);
    for (std::size_t k = 0; k < drive.truth.size(); ++k) {
      const Eigen::Vector3d seen = drive.truth[k].rotation.transpose() * up + offset;
      graph.add_gravity(k, seen + noise.normal(sigma), sigma);
    }
    EXPECT_TRUE(graph.optimise().converged);
    return graph;
  };
  const auto tilt = [&](const PoseGraph& graph) {  // of the last pose against the first
    const Eigen::Vector3d seen = graph.pose(drive.truth.size() - 1).rotation.transpose() * up;
    return std::acos(seen.dot(drive.truth.back().rotation.transpose() * up));
  };
  const PoseGraph graph = levelled(0.5);
  EXPECT_LT((graph.up_offset() - offset).head<2>().norm(), sigma);
  EXPECT_LT(std::acos(graph.up_map()->dot(up)), 2 * sigma);
  EXPECT_LT(tilt(graph), 2 * sigma);
  double chi2 = 0;
  for (const Level& level : graph.levels()) chi2 += level.chi2;
  EXPECT_NEAR(chi2 / (2 * static_cast<double>(graph.levels().size())), 1, 0.2);

  EXPECT_EQ(levelled(0).up_offset(), Eigen::Vector3d::Zero());
  EXPECT_GT(std::acos(levelled(0).up_map()->dot(up)), 3 * sigma);
}

TEST(PoseGraph, AnUpThatIsFarOffIsRejected) {
  const MadeDrive drive = short_drive(9);
  const auto levelled = [&](bool with_false_one) {
    PoseGraph graph = testing::odometry_graph(drive);
    for (std::size_t k = 0; k < drive.truth.size(); ++k) {
      graph.add_gravity(k, drive.truth[k].rotation.transpose() * Eigen::Vector3d::UnitZ(), 0.002);
    }
    if (with_false_one) graph.add_gravity(40, Eigen::Vector3d(0.3, 0.2, 1), 0.002);
    EXPECT_EQ(graph.optimise().rejected_levels, with_false_one ? 1U : 0U);
    return graph;
  };
  const PoseGraph clean = levelled(false);
  const PoseGraph disturbed = levelled(true);
  EXPECT_TRUE(disturbed.levels().back().is_rejected());
  for (std::size_t k = 0; k < drive.truth.size(); ++k) {
    EXPECT_LT(geometry::log_se3(clean.pose(k).inverse() * disturbed.pose(k)).norm(), 0.01);
  }
}

/// A drive of one keyframe: nothing is free to move, whatever was measured there.
TEST(PoseGraph, OneNodeIsSolved) {
  const Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  for (const bool with_fix : {false, true}) {
    for (const bool with_up : {false, true}) {
      PoseGraph graph;
      Pose3 start;
      start.translation = {1, 2, 3};
      graph.add_node(0, start);
      if (with_fix) graph.add_gnss(0, {5, 6, 7}, covariance, {0, 0, 1});
      if (with_up) graph.add_gravity(0, Eigen::Vector3d(0.1, 0, 1), 0.01);
      for (const Start from : {Start::kLastSolution, Start::kGuesses}) {
        const Result result = graph.optimise(from);
        EXPECT_TRUE(result.is_usable) << result.message;
        EXPECT_GE(result.iterations, 0);
        EXPECT_FALSE(result.message.empty());
        EXPECT_EQ(graph.pose(0).matrix(), start.matrix());
      }
    }
  }
}

TEST(PoseGraph, AGraphThatCannotBeSolvedStaysAsItWas) {
  const MadeDrive drive = short_drive(4);
  PoseGraph graph = testing::odometry_graph(drive);
  testing::add_loops(graph, drive, drive.loops);
  ASSERT_TRUE(graph.optimise().is_usable);
  const std::map<NodeId, Pose3> before = graph.poses();
  const std::vector<Edge> edges = graph.edges();
  Pose3 nowhere;
  nowhere.translation.x() = std::numeric_limits<double>::quiet_NaN();
  graph.add_between(3, 9, nowhere, drive.loop_covariance, EdgeKind::kOdometry);
  for (const Start from : {Start::kLastSolution, Start::kGuesses}) {
    const Result result = graph.optimise(from);
    EXPECT_FALSE(result.is_usable);
    EXPECT_FALSE(result.converged);
    EXPECT_GE(result.iterations, 0);
    EXPECT_FALSE(result.message.empty());
    for (const auto& [id, pose] : before) EXPECT_EQ(graph.pose(id).matrix(), pose.matrix());
    for (std::size_t e = 0; e < edges.size(); ++e) {
      EXPECT_EQ(graph.edges()[e].weight, edges[e].weight);
    }
  }
}

TEST(PoseGraph, SaysWhatCannotBeUsed) {
  PoseGraph graph;
  graph.add_node(7, {});
  graph.add_node(8, {});
  const geometry::Matrix6 covariance = geometry::Matrix6::Identity();
  geometry::Matrix6 singular = covariance;
  singular(3, 3) = 0;
  EXPECT_THROW(graph.add_node(7, {}), std::invalid_argument);
  EXPECT_THROW(graph.add_between(7, 9, {}, covariance, EdgeKind::kLoop), std::invalid_argument);
  EXPECT_THROW(graph.add_between(7, 7, {}, covariance, EdgeKind::kLoop), std::invalid_argument);
  EXPECT_THROW(graph.add_between(7, 8, {}, singular, EdgeKind::kLoop), std::invalid_argument);
  EXPECT_THROW(graph.add_gnss(9, {}, Eigen::Matrix3d::Identity(), {}), std::invalid_argument);
  EXPECT_THROW(graph.add_gravity(7, Eigen::Vector3d::Zero(), 0.1), std::invalid_argument);
  EXPECT_THROW(graph.add_gravity(7, Eigen::Vector3d::UnitZ(), 0), std::invalid_argument);
  EXPECT_THROW(graph.pose(9), std::invalid_argument);
  EXPECT_TRUE(graph.edges().empty());
  EXPECT_TRUE(PoseGraph().optimise().converged);
}

}  // namespace
}  // namespace traverse::pose_graph
