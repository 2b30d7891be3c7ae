#include "traverse/voxel_map/alignment.hpp"

#include <gtest/gtest.h>

#include "traverse/optimization/termination.hpp"
#include "traverse/simulation/scanner.hpp"
#include "traverse/simulation/worlds.hpp"

namespace traverse::voxel_map {
namespace {

using optimization::Termination;

/// A lidar that stands in a street, and the map that its first scan makes.
class AlignmentInAStreet : public ::testing::Test {
 protected:
  AlignmentInAStreet() : map_({}), workers_(1) {
    scanner_.azimuth_steps = 900;
    map_.insert(sample(0), geometry::Pose3::identity(), geometry::Twist::Zero(), workers_);
  }

  SweepSample sample(double seconds) {
    return sample_sweep(scanner_.scan(street_, standing_, seconds), scanner_.profile, {}, workers_);
  }

  Alignment align_from(double metres_off, const AlignmentOptions& options,
                       const SweepSample& scan) {
    geometry::Pose3 guess;
    guess.translation.y() = metres_off;
    lidar::StageTimes ignored;
    return align(scan, map_, {{}, 0.1, false}, guess, options, {}, workers_, matches_, ignored);
  }

 private:
  simulation::AnalyticScene street_ = simulation::street(40, 1);
  simulation::Drive standing_{0, 0, 80, 0};
  simulation::Scanner scanner_ = simulation::demo_scanner();
  VoxelMap map_;
  parallel::Workers workers_;
  ScanMatches matches_;
};

TEST_F(AlignmentInAStreet, SaysWhyItEnded) {
  const SweepSample scan = sample(0.1);
  AlignmentOptions options;
  options.rounds = 20;
  const Alignment settled = align_from(0.05, options, scan);
  EXPECT_EQ(settled.health.reason, Termination::kConverged);
  EXPECT_TRUE(settled.health.converged);
  EXPECT_LT(settled.health.steps, 20);
  EXPECT_LT(settled.T_map_lidar.translation.norm(), 0.01);

  options.rounds = 1;
  const Alignment cut_short = align_from(0.05, options, scan);
  EXPECT_EQ(cut_short.health.reason, Termination::kIterationLimit);
  EXPECT_FALSE(cut_short.health.converged);
  EXPECT_TRUE(cut_short.health.registered) << "it may still be good";

  const Alignment nothing = align_from(0.05, options, SweepSample{});
  EXPECT_EQ(nothing.health.reason, Termination::kTooFewMatches);
  EXPECT_FALSE(nothing.health.registered);
  EXPECT_EQ(nothing.T_map_lidar.translation.y(), 0.05) << "the guess stands";
}

}  // namespace
}  // namespace traverse::voxel_map
