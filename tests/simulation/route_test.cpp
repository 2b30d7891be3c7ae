#include "traverse/simulation/route.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace traverse::simulation {
namespace {

using ::testing::HasSubstr;

RouteSettings square() {
  RouteSettings settings;
  settings.waypoints_m = {0, 0, 60, 0, 60, 60, 0, 60};
  settings.closed = true;
  settings.corner_radius_m = 10;
  return settings;
}

ImpossibleRoute error_of(const RouteSettings& settings) {
  try {
    const Route route(settings);
  } catch (const ImpossibleRoute& error) {
    return error;
  }
  ADD_FAILURE() << "the route can be driven";
  return {"", "", ""};
}

TEST(Route, ASquareHasItsLengthItsCornersAndComesBack) {
  const Route route(square());
  EXPECT_NEAR(route.lap_m(), 4 * (60 - 20) + 2 * std::numbers::pi * 10, 1e-9);
  EXPECT_LT((route.point(0) - route.point(route.lap_m())).norm(), 1e-9);
  EXPECT_NEAR(route.heading(20), 0, 1e-6);
  EXPECT_NEAR(route.curvature(20), 0, 1e-9);
  // In the middle of the first arc the curve is a little inside of it, for its smooth ends.
  const double middle = 40 + std::numbers::pi * 10 / 4;
  EXPECT_NEAR(route.heading(middle), std::numbers::pi / 4, 0.01);
  EXPECT_NEAR(route.curvature(middle), 0.1, 0.01);
}

TEST(Route, TwoLapsAreTwiceAsLong) {
  RouteSettings settings = square();
  settings.laps = 2;
  const Route route(settings);
  EXPECT_NEAR(route.length_m(), 2 * route.lap_m(), 1e-12);
  EXPECT_LT((route.point(17) - route.point(17 + route.lap_m())).norm(), 1e-9);
}

TEST(Route, AnotherDriverKeepsBesideTheLineTheSameInEachLap) {
  RouteSettings settings = square();
  settings.laps = 2;
  settings.wander_m = 0.4;
  const Route line(settings);
  const Route other(settings, 3);
  EXPECT_EQ(other.lap_m(), line.lap_m());
  double max_m = 0;
  for (double s = 0; s < line.lap_m(); s += 1) {
    EXPECT_LT((other.point(s) - other.point(s + line.lap_m())).norm(), 1e-9);
    const double beside_m = (other.point(s) - line.point(s)).norm();
    EXPECT_LT(beside_m, 0.401);
    max_m = std::max(max_m, beside_m);
    // The wheels roll along the line that is driven.
    const Eigen::Vector2d ahead = other.point(s + 1e-4) - other.point(s - 1e-4);
    EXPECT_NEAR(std::remainder(std::atan2(ahead.y(), ahead.x()) - other.heading(s), 6.283185307), 0,
                1e-6);
  }
  EXPECT_GT(max_m, 0.1);
  EXPECT_GT((Route(settings, 4).point(30) - other.point(30)).norm(), 0.01);
}

TEST(Route, WhatCannotBeDrivenSaysWhichKeyIsWrong) {
  RouteSettings settings = square();
  settings.corner_radius_m = 31;
  EXPECT_EQ(error_of(settings).key, "corner_radius_m");
  EXPECT_THAT(error_of(settings).expected, HasSubstr("leg of 60.0 m"));

  settings = square();
  settings.waypoints_m = {0, 0, 60};
  EXPECT_EQ(error_of(settings).key, "waypoints_m");
  settings.waypoints_m = {0, 0, 60, 0, 60, 0, 0, 60};
  EXPECT_THAT(error_of(settings).found, HasSubstr("(60, 0) again"));
  settings.closed = false;
  settings.waypoints_m = {0, 0, 60, 0, 10, 0.1};
  EXPECT_THAT(error_of(settings).expected, HasSubstr("turning back"));

  settings = square();
  settings.stops_m = {1000};
  EXPECT_EQ(error_of(settings).key, "stops_m");
}

TEST(Route, AbsurdLengthsAreRefusedBeforeMemoryIsTaken) {
  RouteSettings settings = square();
  for (const double far : {1e7, 1e300}) {
    settings.waypoints_m = {0, 0, far, 0, far, far, 0, far};
    EXPECT_EQ(error_of(settings).key, "waypoints_m") << far;
  }
  settings = square();
  settings.laps = 1000;
  settings.speed_mps = 0.1;
  EXPECT_EQ(error_of(settings).key, "laps");
}

}  // namespace
}  // namespace traverse::simulation
