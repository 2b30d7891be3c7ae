#include "navigation/map_fix.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace traverse::inertial {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const geodesy::LocalTangentPlane kPlane({48, 11, 500});

/// North of the plane's origin by so many metres, nearly.
sensors::GnssFix fix_north(double north_m = 0) {
  sensors::GnssFix result;
  result.stamp = geometry::Stamp::from_seconds(1000);
  result.latitude_deg = 48 + north_m / 111'195;
  result.longitude_deg = 11;
  result.altitude_m = 500;
  return result;
}

double heading_of(double heading_deg, double baseline_angle = 0) {
  sensors::GnssFix with_heading = fix_north();
  with_heading.heading_deg = heading_deg;
  Events events;
  return in_map(with_heading, kPlane, {}, baseline_angle, FixScatter(), events).heading.value();
}

TEST(MapFix, SaysWhatIsNoPlaceAndWhy) {
  Events events;
  EXPECT_TRUE(is_place(fix_north(), events));
  EXPECT_TRUE(events.empty());
  sensors::GnssFix wrong = fix_north();
  for (const double latitude : {kNoNumber, kInfinity, 90.1, -91.0}) {
    wrong.latitude_deg = latitude;
    EXPECT_FALSE(is_place(wrong, events)) << latitude;
  }
  wrong = fix_north();
  wrong.longitude_deg = -kInfinity;
  EXPECT_FALSE(is_place(wrong, events));
  EXPECT_EQ(events.at("fix that is no place"), 5U);
  wrong = fix_north();
  wrong.altitude_m = kNoNumber;
  EXPECT_FALSE(is_place(wrong, events));
  EXPECT_EQ(events.at("fix without altitude"), 1U);
}

TEST(MapFix, IsInMetresOfTheTangentPlane) {
  Events events;
  const MapFix found = in_map(fix_north(100), kPlane, {}, 0, FixScatter(), events);
  EXPECT_EQ(found.stamp, fix_north().stamp);
  EXPECT_NEAR(found.p_antenna_map.x(), 0, 1e-6) << "east";
  EXPECT_NEAR(found.p_antenna_map.y(), 100, 0.5) << "north, of an ellipsoid";
  EXPECT_NEAR(found.p_antenna_map.z(), 0, 0.01) << "up";
  EXPECT_FALSE(found.heading.has_value());
}

TEST(MapFix, IsAsExactAsItSaysOrElseAsTheOptionsDo) {
  GnssOptions options;
  options.horizontal_m = 2;
  options.vertical_m = 5;
  const Eigen::Matrix3d by_options = Eigen::Vector3d(4, 4, 25).asDiagonal();
  Events events;
  EXPECT_EQ(in_map(fix_north(), kPlane, options, 0, FixScatter(), events).covariance, by_options);

  sensors::GnssFix told = fix_north();
  told.covariance_enu = Eigen::Vector3d(0.01, 0.02, 0.09).asDiagonal();
  EXPECT_EQ(in_map(told, kPlane, options, 0, FixScatter(), events).covariance,
            *told.covariance_enu);
  options.use_covariance = false;
  EXPECT_EQ(in_map(told, kPlane, options, 0, FixScatter(), events).covariance, by_options);
  EXPECT_TRUE(events.empty());

  options.use_covariance = true;
  Eigen::Matrix3d skew = *told.covariance_enu;
  skew(0, 1) = 0.005;
  std::size_t wrong = 0;
  for (const Eigen::Matrix3d& P : {Eigen::Matrix3d(Eigen::Matrix3d::Zero()),
                                   Eigen::Matrix3d(Eigen::Matrix3d::Constant(kNoNumber)),
                                   Eigen::Matrix3d(-Eigen::Matrix3d::Identity()), skew}) {
    told.covariance_enu = P;
    EXPECT_EQ(in_map(told, kPlane, options, 0, FixScatter(), events).covariance, by_options)
        << wrong;
    EXPECT_EQ(events.at("fix whose covariance is not positive definite"), ++wrong);
  }
}

TEST(MapFix, ClockwiseFromNorthBecomesCounterclockwiseFromEast) {
  const double half_turn = std::numbers::pi;
  EXPECT_NEAR(heading_of(90), 0, 1e-12) << "east";
  EXPECT_NEAR(heading_of(0), half_turn / 2, 1e-12) << "north";
  EXPECT_NEAR(heading_of(180), -half_turn / 2, 1e-12) << "south";
  EXPECT_NEAR(std::abs(heading_of(270)), half_turn, 1e-12) << "west";
  EXPECT_NEAR(heading_of(720 + 45), half_turn / 4, 1e-12) << "turned twice";
  EXPECT_NEAR(heading_of(90, half_turn / 2), -half_turn / 2, 1e-12)
      << "antennas side by side, the second to the left, that point east: the body points south";
}

TEST(MapFix, AHeadingIsLeftOutWhereItIsNotWantedOrNoNumber) {
  sensors::GnssFix with_heading = fix_north();
  with_heading.heading_deg = kNoNumber;
  Events events;
  EXPECT_FALSE(in_map(with_heading, kPlane, {}, 0, FixScatter(), events).heading.has_value());
  with_heading.heading_deg = 45;
  GnssOptions options;
  options.use_heading = false;
  EXPECT_FALSE(in_map(with_heading, kPlane, options, 0, FixScatter(), events).heading.has_value());
}

TEST(MapFix, BetweenTwoFixesThePlaceIsOnTheLine) {
  MapFix before;
  before.stamp = geometry::Stamp::from_seconds(10);
  before.p_antenna_map = {0, 0, 1};
  MapFix after;
  after.stamp = geometry::Stamp::from_seconds(12);
  after.p_antenna_map = {8, -4, 3};
  after.covariance = 9 * Eigen::Matrix3d::Identity();
  after.heading = 1;
  const MapFix between = interpolated(before, after, geometry::Stamp::from_seconds(10.5));
  EXPECT_LT((between.p_antenna_map - Eigen::Vector3d(2, -1, 1.5)).norm(), 1e-12);
  EXPECT_EQ(between.stamp, geometry::Stamp::from_seconds(10.5));
  EXPECT_EQ(between.covariance, after.covariance);
  EXPECT_FALSE(between.heading.has_value()) << "which may turn between them";
  const MapFix same = interpolated(after, after, after.stamp);
  EXPECT_EQ(same.p_antenna_map, after.p_antenna_map) << "no time between them";
}

}  // namespace
}  // namespace traverse::inertial
