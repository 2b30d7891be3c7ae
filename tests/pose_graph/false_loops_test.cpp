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
  with.optimise();
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
  RecordProperty("odometry_m", std::to_string(f.odometry_m));
  std::printf(
      "seed %u: odometry %.3f m, true loops %.3f m, with false ones %.3f m; rejected %zu "
      "true, accepted %zu false\n",
      GetParam(), f.odometry_m, f.without_m, f.with_m, f.true_rejected, f.false_accepted);
  EXPECT_LT(f.without_m, f.odometry_m);
  EXPECT_LE(f.with_m, 1.1 * f.without_m);
  EXPECT_EQ(f.true_rejected, 0U);
  EXPECT_EQ(f.false_accepted, 0U);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FalseLoops, ::testing::Range(1U, 11U));

}  // namespace
}  // namespace traverse::pose_graph
