#include "traverse/slam/localizer.hpp"

#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "slam/made_drive.hpp"

namespace traverse::slam {
namespace {

using testing::MadeDrive;
using testing::MadeFrame;

/// A street that was mapped, and scans of another pass through it.
class InAMap : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    MadeDrive mapped(geometry::Twist::Zero());
    mapped.pass(4, simulation::Drive{});
    KeyframeMaker maker({}, mapped.profile());
    for (const MadeFrame& made : mapped.frames()) {
      MapKeyframe keyframe;
      keyframe.stamp = made.frame.stamp;
      keyframe.T_map_lidar = made.T_truth;
      keyframe.content =
          maker.make(made.frame, made.scan, testing::points_of(made, mapped.profile()), true);
      map_.push_back(std::move(keyframe));
    }
    simulation::Drive beside;
    beside.amplitude_m = 1.2;
    geometry::Twist drift = geometry::Twist::Zero();
    drift[3] = 0.01;
    drive_ = new MadeDrive(drift);
    drive_->pass(3, beside);
  }
  static void TearDownTestSuite() { delete drive_; }

  static Keyframe scan(std::size_t k) {
    const MadeFrame& made = drive_->frames()[k];
    KeyframeMaker maker({}, drive_->profile());
    return maker.make(made.frame, made.scan, testing::points_of(made, drive_->profile()), true);
  }
  static double error_m(const Localizer::Fix& fix, std::size_t k) {
    const MadeFrame& made = drive_->frames()[k];
    return ((fix.T_map_odom * made.frame.T_map_lidar).translation - made.T_truth.translation)
        .norm();
  }
  /// Few places are tried, so that the tests are quick.
  static LocalizerOptions quick() {
    LocalizerOptions options;
    options.places = 3;
    return options;
  }
  static Localizer localizer() { return {map_, {}, quick()}; }
  /// Nothing of the map is to be seen.
  static Keyframe blank(std::size_t k) {
    Keyframe empty = scan(k);
    empty.points = {};
    empty.features.planar = {};
    empty.features.edges = {};
    return empty;
  }
  static const std::vector<MapKeyframe>& map() { return map_; }
  static const MadeDrive& drive() { return *drive_; }

 private:
  static inline std::vector<MapKeyframe> map_;
  static inline MadeDrive* drive_ = nullptr;
};

TEST_F(InAMap, ThePlaceIsFoundAndHeldWhileOdometryDrifts) {
  Localizer localizer = InAMap::localizer();
  bool located = false;
  for (std::size_t k = 3; k < 13; ++k) {
    const auto fix = localizer.locate(scan(k));
    if (k >= 6) {
      EXPECT_TRUE(fix.located) << "scan " << k;
    }
    located = located || fix.located;
    if (fix.located) {
      EXPECT_LT(error_m(fix, k), 0.05) << "scan " << k;
    }
  }
  EXPECT_TRUE(located);
}

TEST_F(InAMap, AGivenStartIsTakenAtOnce) {
  Localizer localizer = InAMap::localizer();
  geometry::Pose3 start = drive().frames()[5].T_truth;
  start.translation += Eigen::Vector3d(1.5, -1, 0.1);
  localizer.start_at(start);
  const auto fix = localizer.locate(scan(5));
  ASSERT_TRUE(fix.located);
  EXPECT_LT(error_m(fix, 5), 0.05);
}

TEST_F(InAMap, LosingTheMapIsNoticed) {
  Localizer localizer = InAMap::localizer();
  localizer.start_at(drive().frames()[5].T_truth);
  ASSERT_TRUE(localizer.locate(scan(5)).located);
  int scans = 0;
  Localizer::Fix fix = localizer.locate(blank(5));
  for (; fix.located; fix = localizer.locate(blank(5))) {
    EXPECT_FALSE(fix.fits());
    ASSERT_LT(++scans, 20);
  }
  EXPECT_EQ(scans, LocalizerOptions{}.lost_after - 1);
  EXPECT_EQ(fix.verdict, PlaceVerdict::kNotRegistered);
  EXPECT_TRUE(localizer.is_searching());
  // And it is found again when it is there again.
  localizer.locate(scan(6));
  EXPECT_TRUE(localizer.locate(scan(7)).located || localizer.locate(scan(8)).located);
}

TEST_F(InAMap, AScanThatFitsNowhereDoesNotUndoWhatOneBeforeSaid) {
  Localizer localizer = InAMap::localizer();
  const auto first = localizer.locate(scan(5));
  EXPECT_FALSE(first.located) << "one scan alone proves nothing";
  EXPECT_EQ(first.verdict, PlaceVerdict::kAlone);
  EXPECT_FALSE(localizer.locate(blank(6)).located);
  const auto fix = localizer.locate(scan(7));
  ASSERT_TRUE(fix.located);
  EXPECT_LT(error_m(fix, 7), 0.05);
}

TEST_F(InAMap, TwoPlacesThatLookTheSameAreNotTakenForOneAnother) {
  std::vector<MapKeyframe> twice = map();
  for (MapKeyframe keyframe : map()) {
    keyframe.T_map_lidar.translation += Eigen::Vector3d(0, 500, 0);
    twice.push_back(std::move(keyframe));
  }
  Localizer localizer(std::move(twice), {}, {});
  for (std::size_t k = 4; k < 6; ++k) {
    const auto fix = localizer.locate(scan(k));
    EXPECT_FALSE(fix.located) << k;
    EXPECT_EQ(fix.verdict, PlaceVerdict::kNotDistinct) << k;
  }
}

TEST_F(InAMap, AScanThatHasLittleInCommonDoesNotFit) {
  Localizer localizer = InAMap::localizer();
  localizer.start_at(drive().frames()[5].T_truth);
  const auto as_mapped = localizer.locate(scan(5));
  EXPECT_GT(as_mapped.in_common, 0.7);
  Keyframe changed = scan(6);  // of every five points, three are elsewhere today
  for (auto* points : {&changed.features.planar, &changed.features.edges}) {
    for (std::size_t i = 0; i < points->size(); ++i) points->z[i] += i % 5 < 3 ? 30.0F : 0.0F;
  }
  const auto fix = localizer.locate(changed);
  EXPECT_EQ(fix.verdict, PlaceVerdict::kLittleInCommon);
  EXPECT_LT(fix.in_common, 0.6);
  EXPECT_TRUE(fix.located) << "odometry carries the pose on";
}

TEST_F(InAMap, ASlipOfOdometryIsMended) {
  Localizer localizer = InAMap::localizer();
  localizer.start_at(drive().frames()[5].T_truth);
  ASSERT_TRUE(localizer.locate(scan(5)).located);
  Keyframe slipped = scan(6);
  slipped.T_odom_lidar.translation += Eigen::Vector3d(0.7, 0.7, 0);
  const auto fix = localizer.locate(slipped);
  ASSERT_TRUE(fix.fits());
  const geometry::Pose3 placed = fix.T_map_odom * slipped.T_odom_lidar;
  EXPECT_LT((placed.translation - drive().frames()[6].T_truth.translation).norm(), 0.05);
}

TEST_F(InAMap, AMapWithoutKeyframesIsNone) {
  EXPECT_THROW(Localizer({}, {}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::slam
