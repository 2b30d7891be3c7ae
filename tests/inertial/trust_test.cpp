// Who is believed: fixes that were rejected, wheels that jumped, what fixes scatter by, first
// fixes.

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "factors/imu_shaking.hpp"
#include "factors/rejected_fixes.hpp"
#include "factors/rejected_headings.hpp"
#include "factors/wheel_jumps.hpp"
#include "inertial/moment.hpp"
#include "navigation/first_fixes.hpp"
#include "navigation/fix_scatter.hpp"
#include "navigation/heading_scatter.hpp"

namespace traverse::inertial {
namespace {

using testing::moment;

TEST(RejectedFixes, LieOnALineWhereTheyAgreeWithEachOther) {
  RejectedFixes fixes;
  const Eigen::Matrix3d R = 0.01 * Eigen::Matrix3d::Identity();
  for (int k = 0; k < 25; ++k) {
    if (k < 20) {
      EXPECT_FALSE(fixes.line(2).has_value()) << k;
    }
    fixes.add(moment(0.1 * k), {5 + 0.2 * k, 1, -2}, R);
  }
  const auto line = fixes.line(2);
  ASSERT_TRUE(line.has_value());
  EXPECT_LT((line->offset - Eigen::Vector3d(5 + 0.2 * 24, 1, -2)).norm(), 1e-9);
  EXPECT_LT((line->slope - Eigen::Vector3d(2, 0, 0)).norm(), 1e-9);
  EXPECT_LT((line->of_fix - R).norm(), 1e-9) << "they scatter less than they say";
  // Of the value of a line at its last point: about 4 of a fix's variance by their number.
  EXPECT_NEAR(line->of_offset(0, 0), 4 * 0.01 / 21, 2e-4);
}

TEST(RejectedFixes, ThatScatterAreAsGoodAsTheirScatter) {
  RejectedFixes fixes;
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 400; ++k) {
    fixes.add(moment(0.01 * k), 3 * Eigen::Vector3d{normal(generator), normal(generator), 0},
              1e-4 * Eigen::Matrix3d::Identity());
  }
  const auto line = fixes.line(3.9);
  ASSERT_TRUE(line.has_value());
  EXPECT_NEAR(std::sqrt(line->of_fix(0, 0)), 3, 0.3);
  EXPECT_LT(std::abs(line->offset.x()), 3.3 * std::sqrt(line->of_offset(0, 0)));
}

TEST(RejectedHeadings, ThatAgreeSayWhatTheEstimateIsOffBy) {
  const auto offset = [](double sigma, unsigned wrong_in_10, double off) {
    RejectedHeadings headings;
    std::mt19937 generator(6);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> angle(-3, 3);
    for (int k = 0; k < 60; ++k) {
      const double noise = sigma * normal(generator);
      const double wrong = angle(generator);
      const bool is_wrong = generator() % 10 < wrong_in_10;
      const double residual = is_wrong ? wrong : std::remainder(off + noise, 2 * std::numbers::pi);
      headings.add(moment(0.1 * k), residual, sigma, std::abs(residual) > 3.3 * sigma);
    }
    return headings.offset(2);
  };
  for (const unsigned wrong_in_10 : {0U, 1U, 3U}) {
    for (const double off : {0.5, -1.0, 3.14}) {
      const auto found = offset(0.03, wrong_in_10, off);
      ASSERT_TRUE(found.has_value()) << wrong_in_10;
      EXPECT_NEAR(std::remainder(*found - off, 2 * std::numbers::pi), 0, 0.03) << wrong_in_10;
    }
    EXPECT_FALSE(offset(0.03, wrong_in_10, 0).has_value()) << "most are believed";
  }
  EXPECT_FALSE(offset(0.03, 10, 0.5).has_value()) << "they scatter";
}

TEST(RejectedHeadings, SayNothingBeforeTheirTime) {
  RejectedHeadings headings;
  for (int k = 0; k < 20; ++k) {
    headings.add(moment(0.1 * k), 0.5, 0.01, true);
    EXPECT_FALSE(headings.offset(2).has_value());
  }
  headings.add(moment(2), 0.5, 0.01, true);
  EXPECT_TRUE(headings.offset(2).has_value());
}

TEST(WheelJumps, AWheelThatLocksIsToBlameUntilItGrips) {
  for (const double slipping_mps : {-5.0, 5.0}) {  // the estimate's speed less the wheels'
    WheelJumps jumps(0.05);
    double t = 0;
    const auto add = [&](double excess) { jumps.add(moment(t += 0.1), excess); };
    for (int k = 0; k < 10; ++k) add(0.02);
    EXPECT_FALSE(jumps.has_jumped());
    add(0.6 * slipping_mps);  // in the middle of a reading
    add(slipping_mps);
    EXPECT_TRUE(jumps.has_jumped());
    for (int k = 0; k < 30; ++k) add(slipping_mps);
    EXPECT_TRUE(jumps.has_jumped());
    add(0.04);
    EXPECT_FALSE(jumps.has_jumped()) << "it has jumped back";
  }
}

TEST(WheelJumps, AnEstimateThatDriftsIsNoJump) {
  WheelJumps jumps(0.05);
  for (int k = 0; k < 100; ++k) jumps.add(moment(0.1 * k), 0.03 * k);
  EXPECT_FALSE(jumps.has_jumped());
}

TEST(FixScatter, FindsTheDeviationOfFixesOnAnyMotion) {
  for (const double hz : {1.0, 5.0, 10.0, 50.0}) {
    for (const double sigma : {0.015, 0.5}) {
      FixScatter scatter;
      std::mt19937 generator(3);
      std::normal_distribution<double> normal;
      const auto v = [](double t) {
        return Eigen::Vector3d(8 * std::sin(0.5 * t), 8 * std::cos(0.3 * t), 0);
      };
      const auto p = [](double t) {
        return Eigen::Vector3d(-16 * std::cos(0.5 * t), 8 / 0.3 * std::sin(0.3 * t), 0);
      };
      double next = 0;
      int fixes = 0;
      for (int k = 1; fixes < 120; ++k) {
        const double t = 0.01 * k;
        scatter.add_motion(0.01, v(t) - v(t - 0.01) + Eigen::Vector3d(3e-4, 0, 0));  // a tilt
        if (t < next) continue;
        next += 1 / hz;
        ++fixes;
        Eigen::Vector3d z = p(t) + sigma * Eigen::Vector3d{normal(generator), normal(generator),
                                                           2 * normal(generator)};
        if (fixes % 15 == 0) z.x() += 40;  // an outlier
        scatter.add(moment(t), z, Eigen::Vector3d::Zero());
      }
      const auto found = scatter.sigma();
      if (hz == 50) {
        EXPECT_LE(scatter.fixes(), 24U - 3) << "one in five, 0.1 s apart";
        continue;
      }
      ASSERT_TRUE(found.has_value());
      // A seventh of them is off, and four differences with each.
      EXPECT_NEAR(found->horizontal_m, sigma, 0.4 * sigma) << hz;
      EXPECT_NEAR(found->vertical_m, 2 * sigma, 0.7 * sigma) << hz;
    }
  }
}

TEST(FirstFixes, TheFirstThatTheNextAgreesWithMakesTheOrigin) {
  const auto fix = [](double seconds, double latitude) {
    sensors::GnssFix result;
    result.stamp = moment(seconds);
    result.latitude_deg = latitude;
    return result;
  };
  FirstFixes first;
  Events events;
  EXPECT_FALSE(first.add(fix(0, 20), events).has_value());
  EXPECT_FALSE(first.add(fix(0.1, 48.001), events).has_value());
  const auto origin = first.add(fix(0.2, 48.0011), events);  // 11 m
  ASSERT_TRUE(origin.has_value());
  EXPECT_EQ(origin->latitude_deg, 48.001);
  EXPECT_EQ(events.at("first fix that the next does not agree with"), 1U);
}

TEST(HeadingScatter, IsThatOfHeadingsThatAreNotWrongAltogether) {
  constexpr double kTold = 0.005;
  for (const double sigma : {0.005, 0.03}) {
    for (const unsigned one_in : {0U, 10U, 4U}) {
      HeadingScatter scatter;
      std::mt19937 generator(2);
      std::normal_distribution<double> normal;
      std::uniform_real_distribution<double> angle(-3, 3);
      for (int k = 0; k < 800; ++k) {  // a reading each 10 ms, a heading each 100 ms
        sensors::ImuSample sample;
        sample.stamp = moment(0.01 * k);
        sample.angular_rate = {0, 0, 0.7};
        scatter.add(sample);
        if (k % 10 != 0) continue;
        const double right = 0.7 * 0.01 * k + sigma * normal(generator);
        const double wrong = angle(generator);
        const bool is_wrong = one_in > 0 && generator() % one_in == 0;
        scatter.add(sample.stamp, is_wrong ? wrong : right);
      }
      const double found = scatter.sigma(kTold);
      if (sigma == kTold) {
        EXPECT_EQ(found, kTold) << one_in;
      } else {
        EXPECT_NEAR(found, sigma, 0.35 * sigma) << one_in;
      }
    }
  }
}

TEST(HeadingScatter, SaysNothingOfAFewHeadings) {
  HeadingScatter scatter;
  for (int k = 0; k < 10; ++k) scatter.add(moment(0.1 * k), k % 2);
  EXPECT_EQ(scatter.sigma(0.01), 0.01);
}

/// Half a second of motion with noise of that deviation, after as much of rest.
Preintegration::NoiseScale scale_of(double gyro, double force, double hz, bool is_asked = true) {
  ImuShaking shaking({2e-4, 2e-3, 2e-6, 1e-4, is_asked});
  std::mt19937 generator(4);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 2 * hz; ++k) {
    const double t = k / hz;
    sensors::ImuSample sample;
    sample.stamp = moment(t);
    sample.angular_rate = {0, 0, std::sin(3 * t)};
    sample.specific_force = {3 * std::sin(4 * t), 0, 9.8};
    for (int axis = 0; axis < 3; ++axis) {
      const double of_rate = normal(generator);
      const double of_force = normal(generator);
      sample.angular_rate[axis] += gyro * of_rate;
      sample.specific_force[axis] += force * of_force;
    }
    shaking.add(sample);
  }
  return shaking.scale();
}

TEST(ImuShaking, ScalesWhatIsToldByWhatReadingsScatterBy) {
  for (const double hz : {100.0, 200.0}) {
    const auto told = scale_of(2e-4 * std::sqrt(hz), 2e-3 * std::sqrt(hz), hz);
    EXPECT_EQ(told.gyro, 1) << "as noisy as it says";
    EXPECT_EQ(told.accelerometer, 1);
    const auto shaken = scale_of(0.04, 1, hz);
    EXPECT_NEAR(shaken.gyro, 0.04 / std::sqrt(hz) / 2e-4, 0.2 * shaken.gyro);
    EXPECT_NEAR(shaken.accelerometer, 1 / std::sqrt(hz) / 2e-3, 0.2 * shaken.accelerometer);
    EXPECT_EQ(scale_of(0.04, 1, hz, false).accelerometer, 1) << "it is the vehicle's motion";
  }
}

}  // namespace
}  // namespace traverse::inertial
