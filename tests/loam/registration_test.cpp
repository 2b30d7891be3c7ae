#include "traverse/loam/registration.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "traverse/lidar/registration_health.hpp"

#include "geometry/random_motion.hpp"
#include "loam/room.hpp"
#include "point_motion.hpp"

namespace traverse::loam {
namespace {

using optimization::Termination;
using testing::RandomMotion;
using testing::Room;

double distance(const geometry::Pose3& a, const geometry::Pose3& b) {
  return geometry::log_se3(a.inverse() * b).norm();
}

/// Associates and solves a few times, as odometry does.
SolveResult settle(const Room& room, const geometry::Pose3& truth, geometry::Pose3 guess,
                   const SolverOptions& options) {
  const LocalMap edge_map = Room::map_of(room.edges);
  const LocalMap planar_map = Room::map_of(room.planar);
  const lidar::TimedPoints edges = testing::seen_from(truth, room.edges);
  const lidar::TimedPoints planar = testing::seen_from(truth, room.planar);
  SolveResult result;
  for (int step = 0; step < 10; ++step) {
    const Matches matches =
        associate(edges, planar, edge_map, planar_map, guess, AssociationOptions{}, 1);
    result = solve_pose(matches, guess, options);
    guess = result.T_map_lidar;
  }
  return result;
}

TEST(SolvePose, FindsTheTruePoseInARoomFromAPerturbedGuess) {
  RandomMotion random(1);
  const Room room(0.5);
  for (const LineForm form : {LineForm::kVector, LineForm::kDistance}) {
    SolverOptions options;
    options.line_form = form;
    for (int trial = 0; trial < 5; ++trial) {
      const geometry::Pose3 truth = random.pose(0.3, 1);
      const geometry::Pose3 guess = truth * random.pose(0.02, 0.2);
      const SolveResult result = settle(room, truth, guess, options);
      EXPECT_TRUE(result.usable);
      EXPECT_EQ(result.observability.degenerate, 0);
      EXPECT_LT(distance(result.T_map_lidar, truth), 1e-4);  // of the float32 points
      EXPECT_LT(result.residual_rms_m, 1e-3);
      EXPECT_GT(result.inlier_share, 0.999);
    }
  }
}

TEST(SolvePose, FindsTheMotionOfASweepFromPointsThatSawPartsOfIt) {
  RandomMotion random(5);
  const geometry::Pose3 truth = random.pose(0.3, 2);
  Matches matches;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const double s = random.uniform(0, 1);
    const Eigen::Vector3d p = random.vector(20);
    const Eigen::Vector3d q = part_of(truth, s) * p;
    const Eigen::Vector3d u = random.vector(1).normalized();
    if (i % 2 == 0) {
      matches.lines.push_back({i, p, Line{q + random.uniform(-1, 1) * u, u}, s});
    } else {
      matches.planes.push_back({i, p, Plane{u, -u.dot(q)}, s});
    }
  }
  for (const auto& [name, derivative] : optimization::kDerivativeNames) {
    for (const LineForm form : {LineForm::kVector, LineForm::kDistance}) {
      SolverOptions options;
      options.line_form = form;
      options.derivative = derivative;
      options.iterations = 50;
      const SolveResult result = solve_pose(matches, truth * random.pose(0.02, 0.2), options);
      EXPECT_LT(distance(result.T_map_lidar, truth), 1e-5) << name;
      EXPECT_LT(result.residual_rms_m, 1e-5) << name;
      EXPECT_EQ(result.inlier_share, 1) << name;
    }
  }
  for (auto& match : matches.lines) match.fraction = 1;
  for (auto& match : matches.planes) match.fraction = 1;
  EXPECT_GT(distance(solve_pose(matches, truth, SolverOptions{}).T_map_lidar, truth), 0.01)
      << "the fractions were needed";
}

TEST(SolvePose, WithoutEndWallsThePredictionStandsAlongTheAxis) {
  Room room(0.5);
  std::erase_if(room.planar, [](const auto& p) { return std::abs(p.x()) > 9.9; });
  room.edges.clear();
  // Noise, so that the axis is not free by chance but by the test of the eigenvalues.
  RandomMotion random(2);
  for (auto& p : room.planar) p += random.vector(0.02);
  const geometry::Pose3 truth;
  geometry::Pose3 guess;
  guess.translation = {0.3, 0.1, -0.05};
  const SolveResult result = settle(room, truth, guess, SolverOptions{});
  EXPECT_EQ(result.observability.degenerate, 1);
  EXPECT_GT(std::abs(result.observability.directions(3, 0)), 0.99) << "the axis is x";
  EXPECT_NEAR(result.T_map_lidar.translation.x(), 0.3, 0.01);
  EXPECT_NEAR(result.T_map_lidar.translation.y(), 0, 0.01);
  EXPECT_NEAR(result.T_map_lidar.translation.z(), 0, 0.01);
}

/// Points up to 20 m around on planes every way, each off its plane by noise.
Matches noisy_planes(RandomMotion& random, const geometry::Pose3& truth, double sigma_m) {
  std::mt19937 generator(static_cast<unsigned>(random.uniform(0, 1e9)));
  std::normal_distribution<double> noise(0, sigma_m);
  Matches matches;
  for (std::uint32_t i = 0; i < 300; ++i) {
    const Eigen::Vector3d p = random.vector(20);
    const Eigen::Vector3d n = random.vector(1).normalized();
    matches.planes.push_back({i, p, Plane{n, -n.dot(truth * p) + noise(generator)}});
  }
  return matches;
}

/// With residuals that are independent noise the normalised squared error is a chi-square of six.
TEST(SolvePose, CovarianceIsThatOfTheErrors) {
  constexpr int kTrials = 1000;
  RandomMotion random(6);
  SolverOptions options;
  options.iterations = 50;
  options.huber_m = 10;
  double sum = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const geometry::Pose3 truth = random.pose(1, 5);
    const Matches matches = noisy_planes(random, truth, 0.05);
    const SolveResult result = solve_pose(matches, truth, options);
    lidar::RegistrationHealth health;
    health.plane_matches = matches.planes.size();
    health.residual_rms_m = result.residual_rms_m;
    health.observability = result.observability;
    const geometry::Twist error = geometry::log_se3(truth.inverse() * result.T_map_lidar);
    sum += error.dot(health.covariance().ldlt().solve(error));
  }
  // 95 % of the mean of so many chi-squares of six.
  EXPECT_NEAR(sum / kTrials, 6, 2 * std::sqrt(2.0 * 6 / kTrials));
}

TEST(SolvePose, SaysWhyItEnded) {
  RandomMotion random(7);
  const geometry::Pose3 truth = random.pose(0.3, 1);
  const Matches matches = noisy_planes(random, truth, 0.01);
  const geometry::Pose3 guess = truth * random.pose(0.1, 1);
  SolverOptions options;
  options.iterations = 50;
  EXPECT_EQ(solve_pose(matches, guess, options).reason, Termination::kConverged);
  options.iterations = 1;
  EXPECT_EQ(solve_pose(matches, guess, options).reason, Termination::kIterationLimit);
  EXPECT_TRUE(solve_pose(matches, guess, options).usable);
  Matches broken = matches;
  broken.planes.front().plane.offset = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(solve_pose(broken, guess, options).reason, Termination::kNotSolvable);
  EXPECT_FALSE(solve_pose(broken, guess, options).usable);
}

TEST(SolvePose, TooFewMatchesLeaveTheGuess) {
  RandomMotion random(3);
  const geometry::Pose3 guess = random.pose(1, 5);
  Matches matches;
  matches.planes.resize(3, PlaneMatch{0, {1, 2, 3}, Plane{{0, 0, 1}, 0}});
  const SolveResult result = solve_pose(matches, guess, SolverOptions{});
  EXPECT_FALSE(result.usable);
  EXPECT_EQ(result.reason, Termination::kTooFewMatches);
  EXPECT_EQ(result.T_map_lidar.matrix(), guess.matrix());
  EXPECT_EQ(result.observability.degenerate, 6);
}

TEST(SolvePose, OutliersHaveBoundedPull) {
  const Room room(0.5);
  RandomMotion random(4);
  const geometry::Pose3 truth = random.pose(0.3, 1);
  const lidar::TimedPoints planar = testing::seen_from(truth, room.planar);
  Matches matches = associate({}, planar, Room::map_of(room.edges), Room::map_of(room.planar),
                              truth, AssociationOptions{}, 1);
  for (std::size_t i = 0; i < matches.planes.size(); i += 10) matches.planes[i].plane.offset += 2;
  const SolveResult result = solve_pose(matches, truth, SolverOptions{});
  EXPECT_LT(distance(result.T_map_lidar, truth), 0.05);
  EXPECT_NEAR(result.inlier_share, 0.9, 0.01);
}

}  // namespace
}  // namespace traverse::loam
