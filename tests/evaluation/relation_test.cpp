#include "traverse/evaluation/relation.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "traverse/geometry/so3.hpp"

#include "geometry/random_motion.hpp"

namespace traverse::evaluation {
namespace {

using geometry::Pose3;

/// An estimate that is off by a known rotation and translation in its own frame.
class Relations : public ::testing::Test {
 protected:
  static constexpr double kAngle = 0.3;
  testing::RandomMotion random_{1};
  Pose3 reference_ = random_.pose(3, 100);
  Pose3 E_{geometry::exp_so3(random_.vector(1).normalized() * kAngle), {1, -2, 2}};
  Pose3 estimate_ = reference_ * E_;
};

TEST_F(Relations, AbsoluteErrorsOfAKnownTransform) {
  EXPECT_NEAR(absolute_error(estimate_, reference_, Relation::kTranslation), 3, 1e-12);
  EXPECT_NEAR(absolute_error(estimate_, reference_, Relation::kPointDistance), 3, 1e-12);
  EXPECT_NEAR(absolute_error(estimate_, reference_, Relation::kAngleRad), kAngle, 1e-14);
  EXPECT_NEAR(absolute_error(estimate_, reference_, Relation::kAngleDeg),
              kAngle * 180 / std::numbers::pi, 1e-12);
  const double rotation = 2 * std::sqrt(2) * std::sin(kAngle / 2);
  EXPECT_NEAR(absolute_error(estimate_, reference_, Relation::kRotation), rotation, 1e-14);
  EXPECT_NEAR(absolute_error(estimate_, reference_, Relation::kFull),
              std::sqrt(rotation * rotation + 9), 1e-12);
  EXPECT_THROW(absolute_error(estimate_, reference_, Relation::kPointDistanceRatio),
               std::invalid_argument);
}

TEST_F(Relations, RelativeErrorsDoNotDependOnTheMapFrames) {
  const Pose3 later_reference = reference_ * Pose3{geometry::exp_so3({0, 0, 1}), {10, 0, 0}};
  const Pose3 later_estimate = estimate_ * Pose3{geometry::exp_so3({0, 0, 1.1}), {11, 0, 0}};
  const Motion reference{reference_, later_reference};
  const Motion estimate{estimate_, later_estimate};
  EXPECT_NEAR(relative_error(estimate, reference, Relation::kTranslation), 1, 1e-12);
  EXPECT_NEAR(relative_error(estimate, reference, Relation::kAngleRad), 0.1, 1e-14);
  EXPECT_NEAR(relative_error(estimate, reference, Relation::kPointDistance), 1, 1e-12);
  EXPECT_NEAR(relative_error(estimate, reference, Relation::kPointDistanceRatio), 10, 1e-11);
}

TEST_F(Relations, TinyAnglesAreNotLostToRounding) {
  const Pose3 turned = reference_ * Pose3{geometry::exp_so3({0, 1e-9, 0}), {0, 0, 0}};
  EXPECT_NEAR(absolute_error(turned, reference_, Relation::kAngleRad), 1e-9, 1e-15);
}

TEST(RelationNames, AreThoseOfTheCommandLine) {
  EXPECT_EQ(name_of(Relation::kPointDistanceRatio), "point-distance-ratio");
  EXPECT_EQ(unit_of(Relation::kAngleDeg), "deg");
  EXPECT_EQ(unit_of(Relation::kFull), "");
}

}  // namespace
}  // namespace traverse::evaluation
