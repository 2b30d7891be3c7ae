#include "traverse/lidar/deskew.hpp"

#include <gtest/gtest.h>

#include "geometry/random_motion.hpp"

namespace traverse::lidar {
namespace {

using testing::RandomMotion;

TEST(Deskew, IsTheExponentialOfTheMotionAtEachPointsTime) {
  RandomMotion random(1);
  for (const double rate : {0.0, 1e-5, 0.3, 20.0}) {
    geometry::Twist velocity;
    velocity << random.vector(1).normalized() * rate, random.vector(15);
    TimedPoints points;
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3f p = random.vector(50).cast<float>();
      points.push_back(p.x(), p.y(), p.z(), static_cast<float>(random.uniform(-0.05, 0.05)));
    }
    const TimedPoints moved = deskewed(points, velocity);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d expected =
          geometry::exp_se3(points.time[i] * velocity) * points.point(i);
      EXPECT_LT((moved.point(i) - expected).norm(), 1e-5) << "rate " << rate;  // float32 at 50 m
    }
  }
}

TEST(Deskew, APointSeenBeforeTheStampMovesBackWhenDrivingForward) {
  // Driving along x at 10 m/s; seen 0.05 s before the stamp, at the stamp it is 0.5 m nearer.
  TimedPoints points;
  points.push_back(20, 0, 0, -0.05F);
  geometry::Twist velocity = geometry::Twist::Zero();
  velocity[3] = 10;
  EXPECT_FLOAT_EQ(deskewed(points, velocity).x[0], 19.5F);
}

}  // namespace
}  // namespace traverse::lidar
