#include "traverse/evaluation/consistency.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <set>
#include <stdexcept>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "traverse/evaluation/evaluation_error.hpp"
#include "traverse/evaluation/statistics.hpp"
#include "traverse/statistics/quantile.hpp"

#include "geometry/random_motion.hpp"

namespace traverse::evaluation {
namespace {

using geometry::Pose3;

struct Scan {
  std::vector<float> x, y, z;
  Pose3 T_map_lidar;

  void add(const Eigen::Vector3d& p_lidar) {
    x.push_back(static_cast<float>(p_lidar.x()));
    y.push_back(static_cast<float>(p_lidar.y()));
    z.push_back(static_cast<float>(p_lidar.z()));
  }
};

/// Scans of a ground and a wall by a sensor that drives past, `noise_m` off the surfaces; the poses
/// that are handed over with them are `pose_error_m` wrong.
std::vector<Scan> street(int scans, double noise_m, double pose_error_m,
                         const Eigen::Vector3d& p_map_start = Eigen::Vector3d::Zero()) {
  testing::RandomMotion random(1);
  std::vector<Scan> street;
  for (int k = 0; k < scans; ++k) {
    const Pose3 T_map_lidar{Eigen::Matrix3d::Identity(),
                            p_map_start + Eigen::Vector3d(0.2 * k, 0, 1.7)};
    Scan scan;
    for (int i = 0; i < 3000; ++i) {
      const double along = random.uniform(-6, 8);
      const double across = random.uniform(0, 8);
      const double off = random.uniform(-noise_m, noise_m);
      const Eigen::Vector3d p_map = i % 2 == 0 ? Eigen::Vector3d(along, across, off)
                                               : Eigen::Vector3d(along, 8 + off, 0.3 * across);
      scan.add(p_map + p_map_start - T_map_lidar.translation);
    }
    scan.T_map_lidar = T_map_lidar;
    scan.T_map_lidar.translation += random.vector(pose_error_m);
    street.push_back(scan);
  }
  return street;
}

std::optional<Consistency> score_of(const std::vector<Scan>& scans) {
  ConsistencyScorer scorer("raw");
  for (const Scan& scan : scans) scorer.add(scan.x, scan.y, scan.z, scan.T_map_lidar);
  return scorer.score();
}

bool is_query(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352d;
  x ^= x >> 15;
  x *= 0x846ca68b;
  x ^= x >> 16;
  return x % 40 == 0;
}

/// The definition, word for word, every point against every other.
Consistency score_by_definition(const std::vector<Scan>& scans) {
  std::vector<Eigen::Vector3d> points;
  std::vector<int> scan_of;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    std::set<std::array<double, 3>> voxels;
    for (std::size_t i = 0; i < scans[k].x.size(); ++i) {
      const Eigen::Vector3d p(scans[k].x[i], scans[k].y[i], scans[k].z[i]);
      if (!(p.norm() >= 5 && p.norm() <= 40)) continue;
      if (!voxels
               .insert({std::floor(p.x() / 0.2), std::floor(p.y() / 0.2), std::floor(p.z() / 0.2)})
               .second) {
        continue;
      }
      points.push_back(scans[k].T_map_lidar * p);
      scan_of.push_back(static_cast<int>(k));
    }
  }
  const auto covariance = [](const std::vector<Eigen::Vector3d>& set, Eigen::Vector3d& mean) {
    mean.setZero();
    for (const auto& p : set) mean += p / static_cast<double>(set.size());
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const auto& p : set) sum += (p - mean) * (p - mean).transpose();
    return (sum / static_cast<double>(set.size())).eval();
  };
  Consistency score;
  std::vector<double> distances;
  for (std::size_t q = 0; q < points.size(); ++q) {
    if (!is_query(static_cast<std::uint32_t>(q))) continue;
    std::vector<Eigen::Vector3d> all, far;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if ((points[i] - points[q]).norm() > 0.5) continue;
      all.push_back(points[i]);
      if (std::abs(scan_of[i] - scan_of[q]) >= 10) far.push_back(points[i]);
    }
    if (all.size() < 12) continue;
    ++score.queries;
    Eigen::Vector3d mean;
    const Eigen::Matrix3d S = covariance(all, mean);
    const double e = 2 * std::numbers::pi * std::numbers::e;
    score.mme += 0.5 * std::log(e * e * e * std::max(S.determinant(), 1e-18));
    score.mpv_m += std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(S).eigenvalues()[0]);
    if (far.size() < 12) continue;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> plane(covariance(far, mean));
    const Eigen::Vector3d& l = plane.eigenvalues();
    if (!(l[0] < 0.05 * l[1] && l[1] > 0.1 * l[2])) continue;
    distances.push_back(std::abs(plane.eigenvectors().col(0).dot(points[q] - mean)));
  }
  score.mme /= static_cast<double>(score.queries);
  score.mpv_m /= static_cast<double>(score.queries);
  score.points = points.size();
  const Statistics statistics = statistics_of(distances);
  score.point_to_plane = {distances.size(), statistics.mean, statistics.median,
                          statistics::quantile(distances, 0.9)};
  return score;
}

TEST(Consistency, IsWhatTheDefinitionSays) {
  const auto scans = street(16, 0.05, 0.02);
  const auto found = score_of(scans);
  const Consistency expected = score_by_definition(scans);
  ASSERT_TRUE(found && found->point_to_plane);
  ASSERT_GT(expected.point_to_plane->queries, 20U);
  EXPECT_EQ(found->points, expected.points);
  EXPECT_EQ(found->queries, expected.queries);
  EXPECT_NEAR(found->mme, expected.mme, 1e-6);
  EXPECT_NEAR(found->mpv_m, expected.mpv_m, 1e-8);
  EXPECT_EQ(found->point_to_plane->queries, expected.point_to_plane->queries);
  EXPECT_NEAR(found->point_to_plane->mean_m, expected.point_to_plane->mean_m, 1e-7);
  EXPECT_NEAR(found->point_to_plane->median_m, expected.point_to_plane->median_m, 1e-7);
  EXPECT_NEAR(found->point_to_plane->p90_m, expected.point_to_plane->p90_m, 1e-7);
  EXPECT_EQ(found->scans, 16U);
  EXPECT_EQ(found->points_are, "raw");
}

TEST(Consistency, WrongPosesBlurTheMap) {
  const auto right = score_of(street(12, 0.01, 0));
  const auto wrong = score_of(street(12, 0.01, 0.1));
  ASSERT_TRUE(right && wrong);
  EXPECT_LT(right->mme + 0.5, wrong->mme);
  EXPECT_LT(2 * right->mpv_m, wrong->mpv_m);
  EXPECT_EQ(right->points, wrong->points);  // the set does not depend on the trajectory
}

TEST(Consistency, DoesNotDependOnWhereTheMapFrameIs) {
  // As of coordinates of a national grid, where a float would hold half a metre.
  const auto near = score_of(street(12, 0.02, 0));
  const auto far = score_of(street(12, 0.02, 0, {4.5e6, 5.4e6, 300}));
  ASSERT_TRUE(near && far);
  EXPECT_EQ(near->queries, far->queries);
  EXPECT_NEAR(near->mme, far->mme, 1e-4);
}

TEST(Consistency, RepeatsToTheBitAndGoesOnAfterAScore) {
  const auto scans = street(14, 0.02, 0.01);
  const auto whole = score_of(scans);
  ConsistencyScorer scorer("raw");
  for (std::size_t k = 0; k < scans.size(); ++k) {
    scorer.add(scans[k].x, scans[k].y, scans[k].z, scans[k].T_map_lidar);
    if (k == 5) scorer.score();
  }
  for (int repeat = 0; repeat < 2; ++repeat) {
    const auto again = scorer.score();
    ASSERT_TRUE(whole && again);
    EXPECT_EQ(again->mme, whole->mme);
    EXPECT_EQ(again->mpv_m, whole->mpv_m);
    EXPECT_EQ(again->point_to_plane->mean_m, whole->point_to_plane->mean_m);
  }
}

TEST(Consistency, LeavesOutWhatIsNoPointOrNotInRange) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  Scan scan;
  scan.x = {nan, infinity, 0, 4.9F, 41, 40, -40, 5.01F, 5.02F, 5.3F};
  scan.y = {1, 1, 0, 0, 0, 0, 0, 0, 0, 0};
  scan.z = {1, 1, 0, 0, 0, 0, 0, 0, 0, 0};
  ConsistencyScorer scorer("raw");
  for (int i = 0; i < 12; ++i) scorer.add(scan.x, scan.y, scan.z, Pose3());
  const auto score = scorer.score();  // twelve times the same four points, each its own neighbour
  ASSERT_TRUE(score);
  EXPECT_EQ(score->points, 48U);
}

TEST(Consistency, NothingWithoutNeighbours) {
  EXPECT_FALSE(ConsistencyScorer("raw").score());
  ConsistencyScorer scorer("raw");
  scorer.add({}, {}, {}, Pose3());
  const std::vector<float> one{10};
  scorer.add(one, one, one, Pose3());
  EXPECT_FALSE(scorer.score());
}

TEST(Consistency, RefusesWhatIsNoScanOrNoPlace) {
  ConsistencyScorer scorer("raw");
  const std::vector<float> one{10};
  EXPECT_THROW(scorer.add(one, one, {}, Pose3()), std::invalid_argument);
  Pose3 pose;
  pose.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(scorer.add(one, one, one, pose), std::invalid_argument);
  pose = Pose3();
  pose.rotation *= 1e10;
  EXPECT_THROW(scorer.add(one, one, one, pose), std::invalid_argument);
  scorer.add(one, one, one, Pose3());
  pose = Pose3();
  pose.translation.x() = 6e5;
  EXPECT_THROW(scorer.add(one, one, one, pose), EvaluationError);
}

}  // namespace
}  // namespace traverse::evaluation
