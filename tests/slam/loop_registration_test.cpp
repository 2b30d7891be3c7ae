#include "traverse/slam/loop_registration.hpp"

#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "slam/made_drive.hpp"

namespace traverse::slam {
namespace {

using testing::MadeDrive;

/// Keyframes of a pass through the street, the last of another pass beside it.
class LoopInStreet : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    MadeDrive drive(geometry::Twist::Zero());
    drive.pass(3, simulation::Drive{});
    simulation::Drive beside;
    beside.amplitude_m = 1;
    drive.pass(1.6, beside);
    KeyframeMaker maker({}, drive.profile());
    for (const auto& made : drive.frames()) {
      maker.observe(made.frame);
      keyframes_.push_back(std::make_shared<const Keyframe>(
          maker.make(made.frame, made.scan, testing::points_of(made, drive.profile()), true)));
      truth_.push_back(made.T_truth);
    }
  }
  static Submap submap() {
    std::vector<PlacedKeyframe> placed;
    for (std::size_t i = 0; i < 15; ++i) {
      placed.push_back({keyframes_[i], truth_[7].inverse() * truth_[i]});
    }
    return make_submap(7, placed, {});
  }
  static geometry::Pose3 true_pose() { return truth_[7].inverse() * truth_.back(); }
  static const Keyframe& keyframe(std::size_t i) { return *keyframes_[i]; }
  static const Keyframe& last() { return *keyframes_.back(); }

 private:
  static inline std::vector<std::shared_ptr<const Keyframe>> keyframes_;
  static inline std::vector<geometry::Pose3> truth_;
};

TEST_F(LoopInStreet, FindsThePoseFromAnyStartAroundIt) {
  geometry::Pose3 guess = true_pose();
  guess.translation += Eigen::Vector3d(2.2, -1.4, 0.1);
  guess.rotation = guess.rotation * geometry::exp_so3({0, 0, 0.15});
  const LoopRegistrationOptions options;
  const auto starts = starts_around(guess, {3, 0.2}, options);
  const auto found = register_in(submap(), last().features, starts, options);
  EXPECT_TRUE(found.health.registered);
  const geometry::Twist off = geometry::log_se3(true_pose().inverse() * found.T_centre_lidar);
  EXPECT_LT(off.tail<3>().norm(), 0.03);
  EXPECT_LT(off.head<3>().norm(), 0.003);
  EXPECT_GT(found.overlap, 0.6);
}

TEST_F(LoopInStreet, TheSubmapsOwnCentreTellsWhatOverlapCanBeReached) {
  const LoopRegistrationOptions options;
  const Submap around = submap();
  const double own = overlap_at(geometry::Pose3::identity(), around, keyframe(7).features, options);
  const double other = overlap_at(true_pose(), around, last().features, options);
  EXPECT_GT(own, 0.6);
  EXPECT_LE(other, own);
  EXPECT_GT(other, 0.7 * own);
  geometry::Pose3 beside;
  beside.translation.z() = 0.4;
  EXPECT_LT(overlap_at(beside, around, keyframe(7).features, options), 0.6 * own);
}

TEST_F(LoopInStreet, AWrongPlaceOverlapsLess) {
  geometry::Pose3 elsewhere = true_pose();
  elsewhere.translation.x() += 11;
  const LoopRegistrationOptions options;
  const auto right = register_in(submap(), last().features, std::vector{true_pose()}, options);
  const auto wrong = register_in(submap(), last().features, std::vector{elsewhere}, options);
  EXPECT_LT(wrong.overlap, 0.8 * right.overlap);
}

TEST(LoopStarts, CoverTheRegionFromTheInsideOut) {
  const LoopRegistrationOptions options;
  geometry::Pose3 guess;
  guess.translation = {5, 6, 7};
  const auto starts = starts_around(guess, {2, 0.1}, options);
  EXPECT_EQ(starts.front().translation, guess.translation);
  double farthest = 0;
  for (const auto& start : starts) {
    const double distance = (start.translation - guess.translation).norm();
    EXPECT_GE(distance, farthest - 1e-9);
    farthest = std::max(farthest, distance);
    EXPECT_NEAR(start.translation.z(), 7, 1e-12);
  }
  EXPECT_NEAR(farthest, 2, 0.5);
  EXPECT_EQ(starts_around(guess, {0, 0}, options).size(), 1U);
  EXPECT_LE(starts_around(guess, {500, std::numbers::pi}, options).size(),
            static_cast<std::size_t>(2 * options.max_starts));
}

/// After tracking was lost a prediction is off by kilometres and many turns.
TEST(LoopStarts, AreFewHoweverLargeTheRegionIs) {
  const LoopRegistrationOptions usual;
  LoopRegistrationOptions fine;
  fine.start_spacing_m = 1e-6;
  fine.start_spacing_deg = 1e-6;
  const double infinite = std::numeric_limits<double>::infinity();
  for (const LoopRegistrationOptions& options : {usual, fine}) {
    for (const double radius_m : {0.0, 2.0, 500.0, 30e3, 2e9, 1e300, infinite}) {
      for (const double half_turn_rad : {0.0, 0.1, 3.2, 1e4, 1e12, 1e300, infinite}) {
        const auto starts = starts_around({}, {radius_m, half_turn_rad}, options);
        EXPECT_GE(starts.size(), 1U);
        EXPECT_LE(starts.size(), static_cast<std::size_t>(3 * options.max_starts))
            << radius_m << " m, " << half_turn_rad << " rad";
      }
    }
  }
}

}  // namespace
}  // namespace traverse::slam
