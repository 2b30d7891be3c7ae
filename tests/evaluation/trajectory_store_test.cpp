#include "traverse/evaluation/trajectory_store.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "traverse/evaluation/evaluate.hpp"
#include "traverse/evaluation/json.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/geometry/so3.hpp"

#include "temporary_folder.hpp"

namespace traverse::evaluation {
namespace {

using geometry::Pose3;
using geometry::Stamp;
using testing::TemporaryFolder;

constexpr std::size_t kMore = TrajectoryStore::kPosesInMemory + 3 * TrajectoryStore::kBlock / 2;

Stamp stamp_of(std::size_t i) { return {static_cast<std::int64_t>(100'000'000 * i)}; }

/// A winding road, of which the estimate departs a little.
Pose3 pose_of(std::size_t i, double error) {
  const auto s = static_cast<double>(i);
  return {geometry::exp_so3({0, error * std::sin(s), std::sin(1e-3 * s)}),
          {s + error * std::cos(s), 50 * std::sin(1e-2 * s), error * std::sin(7 * s)}};
}

void expect_same(const Pose3& found, const Pose3& expected, std::size_t i) {
  ASSERT_TRUE(found.rotation == expected.rotation && found.translation == expected.translation)
      << "pose " << i;
}

TEST(TrajectoryStore, GivesBackInAnyOrderWhatDoesNotFitIntoMemory) {
  const TemporaryFolder folder;
  TrajectoryStore store(folder.path());
  for (std::size_t i = 0; i < kMore; ++i) store.push_back(stamp_of(i), pose_of(i, 0.1));
  ASSERT_EQ(store.size(), kMore);
  EXPECT_EQ(store.stamps()[kMore - 1], stamp_of(kMore - 1));
  for (std::size_t k = 0; k < 3 * kMore; k += 7) {
    const std::size_t i = (k * 40'009) % kMore;
    expect_same(store.pose(i), pose_of(i, 0.1), i);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "the file has no name";
}

TEST(TrajectoryStore, GrowsAfterItsLastBlockWentToDisk) {
  const TemporaryFolder folder;
  TrajectoryStore store(folder.path());
  for (std::size_t i = 0; i < kMore; ++i) store.push_back(stamp_of(i), pose_of(i, 0.1));
  for (std::size_t i = 0; i + TrajectoryStore::kBlock < kMore; ++i) store.pose(i);
  for (std::size_t i = kMore; i < kMore + 10; ++i) store.push_back(stamp_of(i), pose_of(i, 0.1));
  for (std::size_t i = 0; i < store.size(); ++i) expect_same(store.pose(i), pose_of(i, 0.1), i);
}

TEST(TrajectoryStore, HasAStampForEachPoseOrForNone) {
  TrajectoryStore stamped;
  stamped.push_back(Stamp{0}, {});
  EXPECT_TRUE(stamped.is_stamped());
  EXPECT_THROW(stamped.push_back(std::nullopt, {}), std::logic_error);
  TrajectoryStore unstamped;
  unstamped.push_back(std::nullopt, {});
  EXPECT_FALSE(unstamped.is_stamped());
  EXPECT_THROW(unstamped.push_back(Stamp{0}, {}), std::logic_error);
}

TEST(TrajectoryStore, NeedsTheFolderOnlyForWhatDoesNotFit) {
  TrajectoryStore store("/nowhere/at/all");
  for (std::size_t i = 0; i < TrajectoryStore::kPosesInMemory; ++i) store.push_back(Stamp{0}, {});
  EXPECT_THROW(store.push_back(Stamp{0}, {}), files::OutputError);
}

TEST(TrajectoryStore, IsEvaluatedToTheSameBitsAsATrajectoryInMemory) {
  const TemporaryFolder folder;
  TrajectoryStore estimate(folder.path());
  TrajectoryStore reference(folder.path());
  geometry::Trajectory estimate_in_memory;
  geometry::Trajectory reference_in_memory;
  for (std::size_t i = 0; i < kMore; ++i) {
    if (i % 5 != 3) {  // not every pose finds a partner
      estimate.push_back(stamp_of(i), pose_of(i, 0.1));
      estimate_in_memory.push_back(stamp_of(i), pose_of(i, 0.1));
    }
    reference.push_back(stamp_of(i), pose_of(i, 0));
    reference_in_memory.push_back(stamp_of(i), pose_of(i, 0));
  }
  EvaluationOptions options;
  options.alignment.mode = AlignmentMode::kSim3;
  options.rpe = {{{10, DeltaUnit::kFrames}, true, PairsFrom::kEstimate},
                 {{100, DeltaUnit::kMetres}, true, PairsFrom::kReference},
                 {{2, DeltaUnit::kRadians}, false, PairsFrom::kEstimate}};
  options.kitti.T_body_camera = pose_of(1, 0.1);
  EXPECT_EQ(to_json(evaluate(estimate, reference, options)),
            to_json(evaluate(estimate_in_memory, reference_in_memory, options)));
}

}  // namespace
}  // namespace traverse::evaluation
