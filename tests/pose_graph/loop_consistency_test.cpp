#include "loop_consistency.hpp"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "traverse/geometry/so3.hpp"

#include "coarse_edges.hpp"
#include "least_uncertain_ways.hpp"
#include "loop_groups.hpp"
#include "odometry_sums.hpp"
#include "pose_graph/made_drive.hpp"

namespace traverse::pose_graph {
namespace {

using testing::MadeDrive;
using testing::MadeDriveOptions;

constexpr double kBound = 16.81;  // 1 % of six degrees of freedom

/// A made drive's graph as the solver sees it: odometry, false loops, true ones.
struct Seen {
  MadeDrive drive;
  PoseGraph graph;
  std::map<NodeId, std::size_t> index_of;

  Seen(const MadeDriveOptions& options, unsigned seed)
      : drive(testing::made_drive(options, seed)), graph(testing::odometry_graph(drive)) {
    testing::add_loops(graph, drive, drive.false_loops);
    testing::add_loops(graph, drive, drive.loops);
    for (std::size_t k = 0; k < drive.truth.size(); ++k) index_of.emplace(k, k);
  }
  GraphParts parts() const { return {graph.edges(), graph.fixes(), graph.levels(), index_of}; }
  bool is_false(std::size_t edge) const {
    return edge >= drive.steps.size() && edge < drive.steps.size() + drive.false_loops.size();
  }
};

MadeDriveOptions without_false_loops() {
  MadeDriveOptions options;
  options.false_share = 0;
  return options;
}

/// By the truth; the chi-squares of `count` motions add up to their degrees of freedom.
void expect_honest(double chi2, std::size_t count) {
  const double freedom = 6.0 * static_cast<double>(count);
  EXPECT_NEAR(chi2 / freedom, 1, 5 * std::sqrt(2 / freedom));
}

TEST(OdometrySums, AreAsCertainAsTheirErrorsShow) {
  double sum = 0;
  std::size_t count = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const Seen seen(without_false_loops(), seed);
    const OdometrySums odometry(seen.parts());
    for (const auto& [i, j] : {std::pair{10U, 60U}, {320U, 150U}}) {
      const geometry::Pose3 truth = seen.drive.truth[i].inverse() * seen.drive.truth[j];
      sum += odometry.chi2(i, j, {truth, geometry::Matrix6::Zero()});
      ++count;
    }
  }
  expect_honest(sum, count);
}

TEST(CoarseEdges, AreAsCertainAsTheirErrorsShow) {
  double sum = 0;
  std::size_t count = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const Seen seen(without_false_loops(), seed);
    const CoarseEdges coarse = coarse_edges(seen.parts(), 25);
    ASSERT_EQ(coarse.nodes, 16U);
    const auto& edge = coarse.edges[seen.drive.steps.size() + seed - 1];  // one of its loops
    ASSERT_TRUE(edge);
    const geometry::Pose3 truth =
        seen.drive.truth[25 * edge->i].inverse() * seen.drive.truth[25 * edge->j];
    geometry::Twist off;
    off << geometry::log_so3(truth.rotation.transpose() * edge->motion.T_i_j.rotation),
        edge->motion.T_i_j.translation - truth.translation;
    sum += off.dot(edge->motion.covariance.ldlt().solve(off));
    ++count;
  }
  expect_honest(sum, count);
}

TEST(CoarseEdges, AChainOfItsOwnBeginsAtACoarseNode) {
  Seen seen(without_false_loops(), 1);
  const std::size_t last = seen.drive.truth.size();
  seen.graph.add_node(last, {});
  seen.graph.add_node(last + 1, {});
  seen.graph.add_between(last, last + 1, {}, geometry::Matrix6::Identity(), EdgeKind::kOdometry);
  seen.graph.add_between(3, last + 1, {}, geometry::Matrix6::Identity(), EdgeKind::kLoop);
  seen.index_of.emplace(last, last);
  seen.index_of.emplace(last + 1, last + 1);
  const CoarseEdges coarse = coarse_edges(seen.parts(), 30);
  EXPECT_EQ(coarse.nodes, 14U + 1U);
  EXPECT_FALSE(coarse.edges[coarse.edges.size() - 2]);
  EXPECT_EQ(coarse.edges.back()->j, 14U);
}

TEST(LeastUncertainWays, GoByTheMoreCertainMotion) {
  LeastUncertainWays ways(4);
  const geometry::Pose3 ahead{geometry::exp_so3({0, 0, 0.4}), {10, 0, 0}};
  const geometry::Pose3 wrong{geometry::exp_so3({0, 0, 0.7}), {14, 0, 0}};
  ways.add(0, 1, {ahead, testing::covariance_of(0.01, 0.1)});
  ways.add(2, 1, {ahead.inverse(), testing::covariance_of(0.01, 0.1)});
  ways.add(0, 2, {wrong, testing::covariance_of(0.1, 1)});
  ways.find();
  const MeasuredMotion around{ahead * ahead, testing::covariance_of(0.01, 0.1)};
  EXPECT_LT(ways.chi2(0, 2, around), 1e-9);
  EXPECT_LT(ways.chi2(2, 0, around.inverse()), 1e-9);
  EXPECT_GT(ways.chi2(0, 2, {wrong, testing::covariance_of(0.01, 0.1)}), 1000);
  EXPECT_EQ(ways.chi2(0, 3, around), 0);  // no way leads there
}

TEST(LoopGroups, TrueLoopsOfTwoLapsAreOneGroupAndFalseOnesAsManyAsWereMade) {
  MadeDriveOptions options;
  options.alike = 5;
  options.loops = 70;  // thirty false ones
  const Seen seen(options, 2);
  const auto groups = loop_groups(seen.parts(), OdometrySums(seen.parts()), 10, kBound);
  ASSERT_GE(groups.size(), 7U);
  EXPECT_EQ(groups[0].size(), 70U);
  EXPECT_FALSE(seen.is_false(groups[0].front()));
  for (std::size_t g = 1; g < groups.size(); ++g) {
    EXPECT_TRUE(seen.is_false(groups[g].front()));
    EXPECT_LE(groups[g].size(), 5U);
  }
}

/// Of loops that solvers have to find out otherwise.
struct Found {
  std::size_t false_left = 0;
  std::size_t true_doubted = 0;
};

Found found(const Seen& seen) {
  const std::vector<bool> doubted = contradicted_loops(seen.parts(), kBound);
  Found result;
  for (std::size_t e = seen.drive.steps.size(); e < doubted.size(); ++e) {
    if (seen.is_false(e) && !doubted[e]) ++result.false_left;
    if (!seen.is_false(e) && doubted[e]) ++result.true_doubted;
  }
  return result;
}

class ContradictedLoops : public ::testing::TestWithParam<unsigned> {};

TEST_P(ContradictedLoops, AreTheFalseOnes) {
  const Found f = found(Seen({}, GetParam()));
  EXPECT_LE(f.false_left, 1U);
  EXPECT_EQ(f.true_doubted, 0U);
}

TEST_P(ContradictedLoops, AreThoseOfAnAliasedStreetAsWell) {
  MadeDriveOptions options;
  options.alike = 26;  // all false ones agree
  const Found f = found(Seen(options, GetParam()));
  EXPECT_EQ(f.false_left, 0U);
  EXPECT_EQ(f.true_doubted, 0U);
}

/// Steps that err five times as much as they say contradict every loop.
TEST_P(ContradictedLoops, AreNotTrueOnesWhenOdometryIsLessCertainThanItSays) {
  Seen seen({}, GetParam());
  seen.drive.step_covariance /= 25;
  seen.graph = testing::odometry_graph(seen.drive);
  testing::add_loops(seen.graph, seen.drive, seen.drive.false_loops);
  testing::add_loops(seen.graph, seen.drive, seen.drive.loops);
  EXPECT_LE(found(seen).true_doubted, 1U);
}

INSTANTIATE_TEST_SUITE_P(Seeds, ContradictedLoops, ::testing::Range(1U, 4U));
INSTANTIATE_TEST_SUITE_P(LongSeeds, ContradictedLoops, ::testing::Range(4U, 11U));

}  // namespace
}  // namespace traverse::pose_graph
