#include "traverse/inertial/navigation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <gtest/gtest.h>

#include "inertial/navigation_figures.hpp"
#include "inertial/simulated_vehicle.hpp"

namespace traverse::inertial {
namespace {

using testing::figures;
using testing::simulate;
using testing::SimulatedDrive;
using testing::SimulatedSensors;
using testing::SimulatedVehicle;
using testing::two_frame;
using testing::window;

constexpr double kSettled = 20;  // seconds, when the uncertainty of the start is over
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Navigation, WindowFollowsAnUrbanDriveToCentimetres) {
  const SimulatedSensors sensors;
  const SimulatedDrive drive = simulate({}, sensors, 60);
  Navigation navigation(window(sensors), drive.mounts);
  const auto f = figures(testing::run(navigation, drive), drive, navigation, kSettled);
  EXPECT_LT(f.position_rmse_m, 0.03);
  EXPECT_LT(f.heading_rmse_deg, 0.1);
}

TEST(Navigation, CarriesOnWithWheelsThroughAnOutage) {
  const SimulatedSensors sensors;
  const SimulatedDrive drive = simulate({}, sensors, 75);
  NavigationOptions options = window(sensors);
  options.outage.spells_s = {30};
  Navigation navigation(options, drive.mounts);
  testing::run(navigation, drive);
  ASSERT_EQ(navigation.outages().size(), 1U);
  const OutageResult& outage = navigation.outages().front();
  EXPECT_GT(outage.distance_m, 250);
  EXPECT_LT(outage.error_m, 0.003 * outage.distance_m);
  EXPECT_LT(outage.error_m, 4 * outage.sigma_m);
}

TEST(Navigation, CovarianceIsThatOfItsErrors) {
  const double nees = testing::mean_nees();
  EXPECT_GT(nees, testing::kLeastNees);
  EXPECT_LT(nees, testing::kMostNees);
}

TEST(Navigation, MarginalisesWithoutLoss) {
  SimulatedSensors sensors;
  sensors.gnss_hz = 2;
  const SimulatedDrive drive = simulate({}, sensors, 40);
  const auto newest = [&](int states) {
    NavigationOptions options = window(sensors);
    options.window.states = states;
    Navigation navigation(options, drive.mounts);
    return testing::run(navigation, drive).back();
  };
  const NavFrame batch = newest(1000);
  for (const int states : {2, 10}) {
    const NavFrame lagged = newest(states);
    const NavState::Tangent d = lagged.state.minus(batch.state);
    for (int k = 0; k < NavState::kTangent; ++k) {
      const double sigma = std::sqrt(batch.covariance(k, k));
      EXPECT_LT(std::abs(d[k]), 0.3 * sigma) << states << " states, unknown " << k;
      EXPECT_NEAR(std::sqrt(lagged.covariance(k, k)) / sigma, 1, 0.1) << states << ", " << k;
    }
  }
}

/// The exercise's finding. The car turns much: there the wheels hold the heading's errors down.
TEST(Navigation, TwoFramesAreSmootherByTheWheelsToo) {
  for (const std::uint32_t seed : {1U, 2U, 3U}) {
    SimulatedSensors sensors;
    sensors.seed = seed;
    sensors.heading_sigma_deg = 0.2;
    const SimulatedDrive drive = simulate({}, sensors, 90);
    const auto roughness = [&](Trigger trigger, Pairing pairing) {
      NavigationOptions options = two_frame(trigger, sensors);
      options.pairing = pairing;
      Navigation navigation(options, drive.mounts);
      return figures(testing::run(navigation, drive), drive, navigation, kSettled).roughness_m;
    };
    const double by_gnss = roughness(Trigger::kGnss, Pairing::kOwn);
    EXPECT_LT(roughness(Trigger::kGnssAndWheels, Pairing::kOwn), 0.97 * by_gnss) << seed;
    EXPECT_LT(roughness(Trigger::kGnssAndWheels, Pairing::kPaired), 0.97 * by_gnss) << seed;
  }
}

TEST(Navigation, FindsLatencyAndMountingAndSlowErrorsOfFixes) {
  SimulatedSensors sensors;
  sensors.gnss_latency_s = 0.1;
  sensors.wheel_turn = {0.03, -0.02};
  SimulatedDrive drive = simulate({}, sensors, 90);
  // Seven seconds after the start fixes begin to wander off to the north, by 0.5 m in a minute.
  for (std::size_t k = 70; k < drive.fixes.size(); ++k) {
    drive.fixes[k].latitude_deg += 7.5e-9 * static_cast<double>(k - 70);
  }
  NavigationOptions options = window(sensors);
  options.gnss.latency_sigma_s = 0.1;
  options.gnss.bias_horizontal_m = 0.5;
  options.gnss.bias_vertical_m = 0.5;
  options.wheels.turn_deg = 3;
  Navigation navigation(options, drive.mounts);
  const auto frames = testing::run(navigation, drive);
  const NavFrame& last = frames.back();
  EXPECT_NEAR(last.state.gnss_latency, 0.1, 0.005);
  EXPECT_NEAR(last.state.wheel_turn[0], 0.03, 0.005);
  EXPECT_NEAR(last.state.wheel_turn[1], -0.02, 0.005);
  const Eigen::Vector3d error =
      last.state.p_map - testing::truth_at(last, drive, navigation).translation;
  const double sigma =
      std::sqrt(last.covariance.block<2, 2>(NavState::kPosition, NavState::kPosition).trace());
  const double of_fixes = 0.69;  // m, at the end
  EXPECT_LT(error.head<2>().norm(), 3 * sigma);
  EXPECT_LT(error.head<2>().norm(), of_fixes - 0.1);
  EXPECT_GT(last.state.gnss_bias.y(), 0.1);
}

TEST(Navigation, SmoothedStatesAreBetterThanTheirFirstEstimates) {
  SimulatedSensors sensors;
  sensors.gnss_sigma_m = 0.5;
  const SimulatedDrive drive = simulate({}, sensors, 50);
  const auto run = [&](WindowOutput output) {
    NavigationOptions options = window(sensors);
    options.window.states = 50;
    options.window.output = output;
    Navigation navigation(options, drive.mounts);
    const auto frames = testing::run(navigation, drive);
    double sigma = 0;
    for (const NavFrame& frame : frames) {
      sigma += frame.covariance(NavState::kPosition, NavState::kPosition);
    }
    return std::tuple{figures(frames, drive, navigation, 10), frames.size(), sigma};
  };
  const auto [newest, newest_frames, newest_sigma] = run(WindowOutput::kNewest);
  const auto [oldest, oldest_frames, oldest_sigma] = run(WindowOutput::kOldest);
  EXPECT_EQ(oldest_frames, newest_frames);
  EXPECT_LT(oldest.position_rmse_m, 0.9 * newest.position_rmse_m);
  EXPECT_LT(oldest.roughness_m, 0.5 * newest.roughness_m);
  EXPECT_LT(oldest_sigma, 0.9 * newest_sigma);
}

TEST(Navigation, PairsAlikeTakeTheFactorsOfTheLaterState) {
  SimulatedSensors sensors;
  sensors.heading_sigma_deg = 0.2;
  const SimulatedDrive drive = simulate({}, sensors, 30);
  NavigationOptions options = two_frame(Trigger::kGnssAndWheels, sensors);
  options.pairing = Pairing::kPaired;
  Navigation navigation(options, drive.mounts);
  const auto frames = testing::run(navigation, drive);
  for (std::size_t k = 1; k < frames.size(); ++k) {
    EXPECT_GE(geometry::seconds_between(frames[k - 1].state.stamp, frames[k].state.stamp), 0.01);
  }
  EXPECT_LT(figures(frames, drive, navigation, kSettled).position_rmse_m, 0.06);
  // Fixes 5 ms after the wheels make no frame of their own.
  sensors.wheel_offset_s = 0.095;
  const SimulatedDrive close = simulate({}, sensors, 20);
  Navigation skipping(options, close.mounts);
  testing::run(skipping, close);
  EXPECT_GT(skipping.events().at("fix within 10 ms of a state"), 50U);
}

TEST(Navigation, TwoFramesTakeTheFactorsOfWhatMadeThem) {
  SimulatedSensors sensors;
  sensors.heading_sigma_deg = 0.2;
  const SimulatedDrive drive = simulate({}, sensors, 20);
  Navigation navigation(two_frame(Trigger::kGnssAndWheels, sensors), drive.mounts);
  int by_gnss = 0;
  int by_wheels = 0;
  for (const NavFrame& frame : testing::run(navigation, drive)) {
    EXPECT_LE(frame.states, 2);
    EXPECT_NE(frame.by_gnss, frame.by_wheels);
    EXPECT_EQ(frame.gnss.rows, frame.by_gnss ? 3 : 0) << "gated apart from the heading";
    EXPECT_EQ(frame.heading.rows, frame.by_gnss ? 1 : 0);
    // The first readings lie before the IMU's history of the speed.
    const bool is_begun = by_wheels > 3;
    if (is_begun) {
      EXPECT_EQ(frame.wheels.rows + frame.standing.rows > 0, frame.by_wheels);
    }
    (frame.by_gnss ? by_gnss : by_wheels) += 1;
  }
  EXPECT_GT(by_gnss, 100);
  EXPECT_GT(by_wheels, 100);

  Navigation gnss_only(two_frame(Trigger::kGnss, sensors), drive.mounts);
  for (const NavFrame& frame : testing::run(gnss_only, drive)) EXPECT_TRUE(frame.by_gnss);
}

TEST(Navigation, ReadingsOfOneMomentShareAState) {
  SimulatedSensors sensors;
  sensors.heading_sigma_deg = 0.2;
  sensors.wheel_offset_s = 0;
  const SimulatedDrive drive = simulate({}, sensors, 15);
  Navigation navigation(two_frame(Trigger::kGnssAndWheels, sensors), drive.mounts);
  geometry::Stamp last;
  for (const NavFrame& frame : testing::run(navigation, drive)) {
    EXPECT_LT(last, frame.state.stamp);
    last = frame.state.stamp;
  }
}

TEST(Navigation, RejectsAFixThatIsFarOffAndCarriesOn) {
  const SimulatedSensors sensors;
  SimulatedDrive drive = simulate({}, sensors, 40);
  drive.fixes[300].latitude_deg += 1e-4;  // 11 m
  Navigation navigation(window(sensors), drive.mounts);
  const auto frames = testing::run(navigation, drive);
  const auto rejected = std::find_if(frames.begin(), frames.end(), [&](const NavFrame& frame) {
    return frame.state.stamp == drive.fixes[300].stamp;
  });
  ASSERT_NE(rejected, frames.end());
  EXPECT_TRUE(rejected->gnss.is_rejected);
  EXPECT_LT(figures(frames, drive, navigation, kSettled).position_rmse_m, 0.03);
}

TEST(Navigation, BelievesFixesThatDisagreeForLong) {
  const SimulatedSensors sensors;
  SimulatedDrive drive = simulate({}, sensors, 50);
  for (std::size_t k = 300; k < drive.fixes.size(); ++k) drive.fixes[k].latitude_deg += 1e-4;
  Navigation navigation(window(sensors), drive.mounts);
  const auto frames = testing::run(navigation, drive);
  EXPECT_EQ(navigation.events().at("navigation begun again after too many fixes were rejected"),
            1U);
  EXPECT_FALSE(frames.back().gnss.is_rejected);
}

TEST(Navigation, DeadReckonsWithoutAnyFix) {
  const SimulatedSensors sensors;
  const SimulatedDrive drive = simulate({}, sensors, 40);
  NavigationOptions options = window(sensors);
  options.start.gnss_wait_s = 2;
  Navigation navigation(options, drive.mounts);
  const auto frames = testing::run(navigation, drive, false, true);
  ASSERT_FALSE(frames.empty());
  EXPECT_FALSE(navigation.plane().has_value());
  double way = 0;
  for (std::size_t k = 1; k < frames.size(); ++k) {
    way += (frames[k].state.p_map - frames[k - 1].state.p_map).norm();
  }
  double truth = 0;
  for (std::size_t k = 1; k < drive.truth.size(); ++k) {
    truth += (drive.truth[k].translation - drive.truth[k - 1].translation).norm();
  }
  EXPECT_NEAR(way / truth, 1, 0.03);
}

TEST(Navigation, SaysWhyItNeverBegan) {
  const SimulatedSensors sensors;
  const SimulatedDrive drive = simulate({}, sensors, 5);
  Navigation nothing(window(sensors), drive.mounts);
  EXPECT_TRUE(nothing.finish().empty());
  EXPECT_EQ(nothing.start_note(), "no IMU reading came");
  Navigation standing(window(sensors), drive.mounts);
  EXPECT_TRUE(testing::run(standing, drive).empty());
  EXPECT_NE(standing.start_note().find("no heading"), std::string::npos);
}

TEST(Navigation, CountsWhatItCannotUse) {
  const SimulatedSensors sensors;
  SimulatedDrive drive = simulate({}, sensors, 30);
  drive.imu[2000].angular_rate.x() = kNaN;
  drive.imu[2100].stamp = drive.imu[2099].stamp;
  drive.imu.erase(drive.imu.begin() + 2200, drive.imu.begin() + 2220);  // 0.2 s
  drive.fixes[200].latitude_deg = kNaN;
  drive.fixes[201].altitude_m = kNaN;
  drive.fixes[202].covariance_enu = Eigen::Matrix3d::Zero();
  drive.fixes[203].covariance_enu = Eigen::Matrix3d::Constant(kNaN);
  drive.fixes[204].heading_deg = kNaN;
  Navigation navigation(window(sensors), drive.mounts);
  const auto frames = testing::run(navigation, drive);
  const auto& events = navigation.events();
  EXPECT_EQ(events.at("IMU reading that is not finite"), 1U);
  EXPECT_EQ(events.at("IMU reading not later than the one before"), 1U);
  EXPECT_GE(events.at("gap between IMU readings"), 1U);
  EXPECT_EQ(events.at("fix that is no place"), 1U);
  EXPECT_EQ(events.at("fix without altitude"), 1U);
  EXPECT_EQ(events.at("fix whose covariance is not positive definite"), 2U);
  for (const NavFrame& frame : frames) EXPECT_TRUE(frame.covariance.allFinite());
  EXPECT_LT(figures(frames, drive, navigation, 28).position_rmse_m, 0.05);
}

TEST(Navigation, StartsAnewAfterALongGap) {
  const SimulatedSensors sensors;
  SimulatedDrive drive = simulate({}, sensors, 60);
  drive.imu.erase(drive.imu.begin() + 2500, drive.imu.begin() + 2800);  // 3 s
  Navigation navigation(window(sensors), drive.mounts);
  const auto frames = testing::run(navigation, drive);
  EXPECT_EQ(navigation.events().at("IMU gap after which navigation started anew"), 1U);
  EXPECT_LT(figures(frames, drive, navigation, 50).position_rmse_m, 0.05);
}

}  // namespace
}  // namespace traverse::inertial
