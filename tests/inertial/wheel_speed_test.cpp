#include "navigation/wheel_speed.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "inertial/moment.hpp"

namespace traverse::inertial {
namespace {

using testing::moment;

sensors::WheelOdometry pulses_at(double seconds, std::int64_t left, std::int64_t right) {
  sensors::WheelOdometry reading;
  reading.stamp = moment(seconds);
  reading.ticks = {left, right};
  return reading;
}

sensors::WheelOdometry speed_at(double seconds, double mps) {
  sensors::WheelOdometry reading;
  reading.stamp = moment(seconds);
  reading.velocity = {mps, 0, 0};
  return reading;
}

constexpr double kStanding = 0.01;  // m/s

/// A centimetre a pulse.
WheelSpeed centimetres() { return {sensors::WheelEncoder{0.01, 0.01}, kStanding}; }

/// A vehicle whose speed is 3 m/s + 2 m/s^2 t, as the IMU tells it from before 0 s on.
void speed_up(WheelSpeed& wheels, double until_s) {
  for (int k = -10; 0.01 * k <= until_s + 1e-9; ++k) wheels.add_change(moment(0.01 * k), 0.02);
}

TEST(WheelSpeed, PulsesTellAMeanSpeedFromTheSecondReadingOn) {
  WheelSpeed wheels = centimetres();
  EXPECT_FALSE(wheels.add(pulses_at(0, 1000, 2000))) << "where they count from is not known";
  EXPECT_FALSE(wheels.is_fresh());
  EXPECT_TRUE(wheels.add(pulses_at(0.1, 1012, 2008)));
  EXPECT_TRUE(wheels.is_fresh());
  EXPECT_NEAR(wheels.last(), 1, 1e-9) << "0.1 m in 0.1 s, the mean of both wheels";
  EXPECT_TRUE(wheels.add(pulses_at(0.3, 992, 1988)));
  EXPECT_NEAR(wheels.last(), -1, 1e-9) << "backwards";
}

TEST(WheelSpeed, PulsesOfUnknownMeaningTellNoSpeed) {
  WheelSpeed wheels(std::nullopt, kStanding);
  EXPECT_FALSE(wheels.add(pulses_at(0, 0, 0)));
  EXPECT_FALSE(wheels.add(pulses_at(0.1, 10, 10)));
  EXPECT_FALSE(wheels.add({})) << "a reading of nothing";
  EXPECT_FALSE(wheels.take(moment(0.1)).has_value());
}

TEST(WheelSpeed, TheImuCarriesAMeanSpeedToTheMomentOfTheState) {
  WheelSpeed wheels = centimetres();
  speed_up(wheels, 0.3);
  wheels.add(pulses_at(0.1, 0, 0));
  wheels.add(pulses_at(0.2, 33, 33));  // 3 * 0.1 + 0.2^2 - 0.1^2 = 0.33 m
  EXPECT_NEAR(wheels.last(), 3.3, 1e-9) << "of the middle of the interval";
  EXPECT_NEAR(wheels.take(moment(0.24)).value(), 3 + 2 * 0.24, 1e-9);
  EXPECT_FALSE(wheels.is_fresh());
  EXPECT_FALSE(wheels.take(moment(0.24)).has_value()) << "it is used up";
}

TEST(WheelSpeed, ReadingsSinceTheLastStateCountTogether) {
  WheelSpeed wheels = centimetres();
  speed_up(wheels, 0.4);
  wheels.add(pulses_at(0.0, 0, 0));
  wheels.add(pulses_at(0.1, 31, 31));
  wheels.add(pulses_at(0.2, 64, 64));  // 0.64 m in 0.2 s: 3.2 m/s at 0.1 s
  EXPECT_NEAR(wheels.take(moment(0.2)).value(), 3.4, 1e-9);
  wheels.add(pulses_at(0.3, 99, 99));
  EXPECT_NEAR(wheels.take(moment(0.3)).value(), 3.6, 1e-9) << "of the last interval alone";
}

TEST(WheelSpeed, ASpeedIsOfItsOwnMoment) {
  WheelSpeed wheels(std::nullopt, kStanding);
  speed_up(wheels, 0.3);
  EXPECT_TRUE(wheels.add(speed_at(0.1, 3.2)));
  EXPECT_NEAR(wheels.take(moment(0.2)).value(), 3.4, 1e-9);
}

TEST(WheelSpeed, AnOldReadingIsNotUsed) {
  WheelSpeed wheels(std::nullopt, kStanding);
  wheels.add(speed_at(0, 5));
  EXPECT_FALSE(wheels.take(moment(WheelSpeed::kOldest + 0.01)).has_value());
  EXPECT_TRUE(wheels.take(moment(WheelSpeed::kOldest - 0.01)).has_value());
}

TEST(WheelSpeed, WhatWasTakenTellsOfEarlierMomentsToo) {
  WheelSpeed wheels(std::nullopt, kStanding);
  speed_up(wheels, 0.3);
  EXPECT_FALSE(wheels.taken_at(moment(0.1)).has_value()) << "nothing was taken";
  wheels.add(speed_at(0.2, 3.4));
  wheels.take(moment(0.24));
  EXPECT_NEAR(wheels.taken_at(moment(0.1)).value(), 3.2, 1e-9);
  EXPECT_FALSE(wheels.taken_at(moment(-0.2)).has_value()) << "before what the IMU told";
  wheels.take(moment(0.25));
  EXPECT_FALSE(wheels.taken_at(moment(0.2)).has_value()) << "the last call found nothing to take";
}

TEST(WheelSpeed, StandingIsCountedFromTheFirstSlowReading) {
  WheelSpeed wheels = centimetres();
  wheels.add(pulses_at(0, 0, 0));
  wheels.add(pulses_at(0.1, 10, 10));
  EXPECT_EQ(wheels.standing_seconds(), 0);
  for (int k = 2; k <= 7; ++k) wheels.add(pulses_at(0.1 * k, 10, 10));
  EXPECT_NEAR(wheels.standing_seconds(), 0.5, 1e-9);
  wheels.add(pulses_at(0.8, 11, 11));
  EXPECT_EQ(wheels.standing_seconds(), 0) << "one pulse ends it";
}

TEST(WheelSpeed, AFaultIsLeftOutAndTheNextReadingsAreUsed) {
  WheelSpeed wheels = centimetres();
  speed_up(wheels, 0.6);
  wheels.add(pulses_at(0.0, 1'000'000, 1'000'000));
  EXPECT_TRUE(wheels.add(pulses_at(0.1, 1'000'031, 1'000'031)));
  EXPECT_FALSE(wheels.add(pulses_at(0.2, 0, 0))) << "the counter began again";
  EXPECT_TRUE(wheels.add(pulses_at(0.3, 35, 35)));
  EXPECT_NEAR(wheels.take(moment(0.3)).value(), 3.6, 1e-9);
  EXPECT_FALSE(wheels.add(pulses_at(0.3, 40, 40))) << "a clock that stands still";
  EXPECT_FALSE(wheels.add(speed_at(0.4, std::numeric_limits<double>::quiet_NaN())));
  EXPECT_FALSE(wheels.add(speed_at(0.5, 1000)));
  EXPECT_FALSE(wheels.take(moment(0.5)).has_value());
}

}  // namespace
}  // namespace traverse::inertial
