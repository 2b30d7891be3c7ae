#include "traverse/evaluation/alignment.hpp"

#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/random_motion.hpp"

namespace traverse::evaluation {
namespace {

using geometry::Pose3;
using testing::RandomMotion;

double distance(const Pose3& a, const Pose3& b) { return (a.matrix() - b.matrix()).norm(); }

/// A reference and an estimate that differ by a transform and a scale only.
class Alignments : public ::testing::Test {
 protected:
  Alignments() {
    RandomMotion random(1);
    T_reference_estimate_ = random.pose(3, 50);
    for (int i = 0; i < 30; ++i) {
      const Pose3 T_estimate = random.pose(3, 20);
      estimate_.push_back({T_estimate.rotation, T_estimate.translation / kScale});
      reference_.push_back(T_reference_estimate_ * T_estimate);
    }
  }

  static constexpr double kScale = 1.25;
  Pose3 T_reference_estimate_;
  std::vector<Pose3> estimate_;
  std::vector<Pose3> reference_;
};

TEST_F(Alignments, Sim3FindsTransformAndScale) {
  const Alignment found = align(estimate_, reference_, {AlignmentMode::kSim3, {}});
  EXPECT_NEAR(found.scale, kScale, 1e-12);
  EXPECT_LT(distance(found.T_reference_estimate, T_reference_estimate_), 1e-11);
  EXPECT_EQ(found.poses_used, 30U);
  const auto poses = aligned(estimate_, found);
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_LT(distance(poses[i], reference_[i]), 1e-11);
}

TEST_F(Alignments, Se3LeavesTheScale) {
  const Alignment found = align(estimate_, reference_, {AlignmentMode::kSe3, {}});
  EXPECT_EQ(found.scale, 1);
  EXPECT_LT((found.T_reference_estimate.rotation - T_reference_estimate_.rotation).norm(), 1e-11);
}

TEST_F(Alignments, ScaleOnlyMovesPositionsAboutTheOrigin) {
  const Alignment found = align(estimate_, reference_, {AlignmentMode::kScale, {}});
  EXPECT_NEAR(found.scale, kScale, 1e-12);
  const Pose3 pose = found(estimate_[3]);
  EXPECT_EQ(pose.rotation, estimate_[3].rotation);
  EXPECT_LT((pose.translation - kScale * estimate_[3].translation).norm(), 1e-12);
}

TEST_F(Alignments, OriginPutsTheFirstPosesTogether) {
  const Alignment found = align(estimate_, reference_, {AlignmentMode::kOrigin, {}});
  EXPECT_EQ(found.scale, 1);
  EXPECT_EQ(found.poses_used, 1U);
  EXPECT_LT(distance(found(estimate_[0]), reference_[0]), 1e-12);
}

TEST_F(Alignments, NoneChangesNothing) {
  const Alignment found = align(estimate_, reference_, {AlignmentMode::kNone, {}});
  EXPECT_EQ(found(estimate_[7]).matrix(), estimate_[7].matrix());
}

TEST_F(Alignments, TheFirstPosesDetermineWhatMovesAll) {
  for (std::size_t i = 10; i < reference_.size(); ++i) reference_[i].translation.x() += 5;
  const Alignment found = align(estimate_, reference_, {AlignmentMode::kSim3, 10});
  EXPECT_EQ(found.poses_used, 10U);
  EXPECT_NEAR(found.scale, kScale, 1e-12);
  EXPECT_NEAR((found(estimate_[20]).translation - reference_[20].translation).norm(), 5, 1e-9);
  EXPECT_EQ(align(estimate_, reference_, {AlignmentMode::kSe3, 1000}).poses_used, 30U);
}

TEST_F(Alignments, RefusesListsThatDoNotMatch) {
  EXPECT_THROW(align(std::span(estimate_).first(3), reference_, {}), std::invalid_argument);
  EXPECT_THROW(align({}, {}, {}), std::invalid_argument);
  EXPECT_THROW(align(estimate_, reference_, {AlignmentMode::kSe3, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::evaluation
