#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>

#include "pose_graph/made_drive.hpp"

namespace traverse::pose_graph {
namespace {

using testing::MadeDrive;
using testing::MadeDriveOptions;

/// Of one seed.
struct Figures {
  double odometry_m = 0;
  double without_m = 0;
  double with_m = 0;
  std::size_t doubted = 0;
  std::size_t true_rejected = 0;
  std::size_t false_accepted = 0;
};

Figures figures(const MadeDriveOptions& made, unsigned seed, const GraphOptions& options = {}) {
  const MadeDrive drive = testing::made_drive(made, seed);
  PoseGraph without = testing::odometry_graph(drive, options);
  PoseGraph with = without;
  Figures result;
  result.odometry_m = testing::position_rmse(without, drive);
  testing::add_loops(without, drive, drive.loops);
  without.optimise();
  result.without_m = testing::position_rmse(without, drive);

  testing::add_loops(with, drive, drive.false_loops);
  testing::add_loops(with, drive, drive.loops);
  result.doubted = with.optimise().doubted_loops;
  result.with_m = testing::position_rmse(with, drive);
  const std::size_t first_loop = drive.steps.size();
  for (std::size_t e = first_loop; e < with.edges().size(); ++e) {
    const bool is_false = e < first_loop + drive.false_loops.size();
    if (is_false && !with.edges()[e].is_rejected()) ++result.false_accepted;
    if (!is_false && with.edges()[e].is_rejected()) ++result.true_rejected;
  }
  return result;
}

class FalseLoops : public ::testing::TestWithParam<unsigned> {};

TEST_P(FalseLoops, OfThirtyPercentCostNoMoreThanATenthOfTheError) {
  const Figures f = figures({}, GetParam());
  std::printf("odometry %.3f m, with true loops %.3f m, with false ones too %.3f m\n", f.odometry_m,
              f.without_m, f.with_m);
  EXPECT_LT(f.without_m, f.odometry_m);
  EXPECT_LE(f.with_m, 1.1 * f.without_m);
  EXPECT_EQ(f.true_rejected, 0U);
  EXPECT_EQ(f.false_accepted, 0U);
}

/// A street that looks like another one: five false loops in a row that confirm each other.
TEST_P(FalseLoops, ThatConfirmEachOtherAreFoundOutByTheRest) {
  MadeDriveOptions made;
  made.alike = 5;
  const Figures f = figures(made, GetParam());
  EXPECT_LE(f.with_m, 1.1 * f.without_m);
  EXPECT_EQ(f.false_accepted, 0U);
}

/// Streets that look like others on a drive of four kilometres: thirteen groups of ten.
TEST_P(FalseLoops, OfManyAliasedStreetsCostNothingOnALongDrive) {
  MadeDriveOptions made;
  made.keyframes_a_lap = 1000;
  made.loops = 300;
  made.alike = 10;
  const Figures f = figures(made, GetParam());
  EXPECT_LE(f.with_m, 1.01 * f.without_m);
  EXPECT_EQ(f.false_accepted, 0U);
  EXPECT_EQ(f.true_rejected, 0U);
  EXPECT_EQ(f.doubted, 129U);  // all false ones, before the solution
}

/// As many of them as of true ones.
TEST_P(FalseLoops, OfFiftyPercentInGroups) {
  MadeDriveOptions made;
  made.false_share = 0.5;
  made.alike = 10;
  const Figures f = figures(made, GetParam());
  EXPECT_LE(f.with_m, 1.01 * f.without_m);
  EXPECT_EQ(f.false_accepted, 0U);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FalseLoops, ::testing::Range(1U, 4U));
INSTANTIATE_TEST_SUITE_P(LongSeeds, FalseLoops, ::testing::Range(4U, 11U));

TEST(FalseLoops, BendAGraphThatBelievesThem) {
  GraphOptions believing;
  believing.robust = false;
  const Figures f = figures({}, 1, believing);
  EXPECT_GT(f.with_m, 10 * f.without_m);
}

TEST(FalseLoops, AreFoundOutOneByOneAsWell) {
  MadeDriveOptions made;
  made.keyframes_a_lap = 80;
  made.loops = 20;
  const MadeDrive drive = testing::made_drive(made, 3);
  PoseGraph at_once = testing::odometry_graph(drive);
  PoseGraph one_by_one = at_once;
  testing::add_loops(at_once, drive, drive.loops);
  at_once.optimise();

  std::vector<MadeDrive::Loop> by_time = drive.loops;
  by_time.insert(by_time.end(), drive.false_loops.begin(), drive.false_loops.end());
  std::sort(by_time.begin(), by_time.end(), [](const auto& a, const auto& b) { return a.j < b.j; });
  for (const auto& loop : by_time) {
    testing::add_loops(one_by_one, drive, {loop});
    one_by_one.optimise();
  }
  one_by_one.optimise(Start::kGuesses);
  EXPECT_LE(testing::position_rmse(one_by_one, drive),
            1.1 * testing::position_rmse(at_once, drive));
}

}  // namespace
}  // namespace traverse::pose_graph
