#include "traverse/geometry/trajectory.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

#include "geometry/random_motion.hpp"

namespace traverse::geometry {
namespace {

Trajectory straight_line() {
  Trajectory trajectory;
  for (int i = 0; i < 5; ++i) {
    Pose3 pose;
    pose.translation.x() = 2.0 * i;
    trajectory.push_back(Stamp::from_seconds(10 + i), pose);
  }
  return trajectory;
}

TEST(Trajectory, PathLengthIsTheSumOfSteps) {
  EXPECT_DOUBLE_EQ(straight_line().path_length(), 8);
  EXPECT_EQ(straight_line().accumulated_distances().front(), 0);
  EXPECT_EQ(Trajectory().path_length(), 0);
}

TEST(Trajectory, InterpolatesInsideTheSpanOnly) {
  const Trajectory line = straight_line();
  EXPECT_NEAR(line.at(Stamp::from_seconds(11.25), 2)->translation.x(), 2.5, 1e-12);
  EXPECT_EQ(line.at(Stamp::from_seconds(14), 2)->translation.x(), 8);
  EXPECT_FALSE(line.at(Stamp::from_seconds(9.9), 2));
  EXPECT_FALSE(line.at(Stamp::from_seconds(14.1), 2));
}

TEST(Trajectory, DoesNotInterpolateAcrossAGap) {
  EXPECT_FALSE(straight_line().at(Stamp::from_seconds(11.5), 0.5));
}

TEST(Trajectory, LeftAndRightTransformsChangeTheMapAndTheBodyFrame) {
  testing::RandomMotion random(1);
  const Pose3 T = random.pose(3, 5);
  const Trajectory line = straight_line();
  EXPECT_TRUE(line.transformed_left(T).pose(3).matrix().isApprox((T * line.pose(3)).matrix()));
  EXPECT_TRUE(line.transformed_right(T).pose(3).matrix().isApprox((line.pose(3) * T).matrix()));
}

TEST(Trajectory, KeepsStampedAndUnstampedApart) {
  Trajectory unstamped = Trajectory::unstamped({Pose3()});
  EXPECT_FALSE(unstamped.is_stamped());
  EXPECT_THROW(unstamped.push_back(Stamp{}, Pose3()), std::logic_error);
  EXPECT_THROW(Trajectory::stamped({Stamp{}}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::geometry
