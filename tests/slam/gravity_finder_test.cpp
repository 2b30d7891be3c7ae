#include "traverse/slam/gravity_finder.hpp"

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/so3.hpp"
#include "traverse/simulation/imu_simulator.hpp"

#include "simulation/motion_settings.hpp"

namespace traverse::slam {
namespace {

using simulation::ImuSettings;
using simulation::ImuSimulator;
using simulation::VehicleMotion;

/// A drive over hills with corners and a stop, seen by an exact odometry ten times a second and by
/// an IMU that sits elsewhere and is turned.
struct HillyDrive {
  VehicleMotion motion = testing::winding_drive();
  ImuSettings imu;
  geometry::Pose3 T_body_lidar{geometry::exp_so3({0.02, -0.05, 0.3}), {1.2, 0.1, 1.8}};
  // What odometry and the IMU tell instead of the truth.
  std::function<void(lidar::Frame&)> disturb_frame = [](lidar::Frame&) {};
  std::function<void(sensors::ImuSample&)> disturb_sample = [](sensors::ImuSample&) {};
  std::function<bool(std::size_t)> is_lost = [](std::size_t) { return false; };  // a scan

  HillyDrive() { imu.mounting = {-0.6, 0.3, 0.5, 5, 3, 90}; }

  geometry::Pose3 T_map_lidar(double seconds) const {
    return motion.state(seconds).at(T_body_lidar).T_map_body;
  }
  Eigen::Vector3d up_odom() const {
    return T_map_lidar(0).rotation.transpose() * Eigen::Vector3d::UnitZ();
  }
  /// Every direction of up that is found.
  std::vector<MeasuredUp> ups(GravityFinder& finder) const {
    const ImuSimulator simulator(imu, motion, 1);
    std::vector<MeasuredUp> found;
    std::size_t sample = 0;
    const auto frames = static_cast<std::size_t>(motion.duration_s() / 0.1);
    for (std::size_t k = 0; k < frames; ++k) {
      const double seconds = 0.1 * static_cast<double>(k);
      for (; 0.01 * static_cast<double>(sample) <= seconds; ++sample) {
        sensors::ImuSample reading = simulator.exact(0.01 * static_cast<double>(sample));
        disturb_sample(reading);
        finder.observe(reading);
      }
      if (is_lost(k)) continue;
      lidar::Frame frame;
      frame.index = k;
      frame.stamp = geometry::Stamp::from_seconds(seconds);
      frame.T_map_lidar = T_map_lidar(0).inverse() * T_map_lidar(seconds);
      frame.health.registered = true;
      disturb_frame(frame);
      if (const auto up = finder.add(frame)) found.push_back(*up);
    }
    return found;
  }
  GravityFinder finder(const GravityOptions& options = {}) const {
    return {options, T_body_lidar.inverse() * imu.mounting.T_body_sensor()};
  }
  double error_deg(const MeasuredUp& up) const {
    return std::acos(std::min(1.0, up.up_odom.dot(up_odom()))) / geometry::kDegree;
  }
};

TEST(GravityFinder, AVehicleThatAcceleratesDoesNotTiltUp) {
  const HillyDrive drive;
  GravityFinder finder = drive.finder();
  const auto ups = drive.ups(finder);
  EXPECT_GE(ups.size(), 6U);
  EXPECT_EQ(finder.turned_away() + finder.with_gaps(), 0U);
  for (const MeasuredUp& up : ups) EXPECT_LT(drive.error_deg(up), 0.02);

  // Up would be far off by the readings alone, as if odometry knew of turns only.
  HillyDrive unaware;
  unaware.disturb_frame = [](lidar::Frame& frame) { frame.T_map_lidar.translation.setZero(); };
  GravityOptions lenient;
  lenient.max_off_m_s2 = 5;
  GravityFinder by_readings = unaware.finder(lenient);
  double worst = 0;
  for (const MeasuredUp& up : unaware.ups(by_readings)) {
    worst = std::max(worst, unaware.error_deg(up));
  }
  EXPECT_GT(worst, 3);
}

TEST(GravityFinder, SigmaIsThatOfTheErrors) {
  HillyDrive drive;
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  const auto noise = [&](double sigma) {
    const double x = normal(generator), y = normal(generator), z = normal(generator);
    return Eigen::Vector3d(sigma * Eigen::Vector3d(x, y, z));
  };
  drive.disturb_frame = [&](lidar::Frame& frame) { frame.T_map_lidar.translation += noise(0.02); };
  drive.disturb_sample = [&](sensors::ImuSample& sample) { sample.specific_force += noise(0.3); };
  GravityOptions options;
  options.odometry_sigma_m = 0.02;
  options.acceleration_share = 0;
  options.min_sigma_deg = 1e-3;
  double chi2 = 0;
  std::size_t freedom = 0;
  for (int repeat = 0; repeat < 20; ++repeat) {
    GravityFinder finder = drive.finder(options);
    for (const MeasuredUp& up : drive.ups(finder)) {
      EXPECT_GT(up.sigma_rad, 0.1 * geometry::kDegree);
      chi2 += std::pow(drive.error_deg(up) * geometry::kDegree / up.sigma_rad, 2);
      freedom += 2;
    }
  }
  EXPECT_NEAR(chi2 / static_cast<double>(freedom), 1, 0.2);
}

TEST(GravityFinder, DoesWithoutWindowsThatCannotBeTrusted) {
  HillyDrive drive;
  drive.disturb_sample = [](sensors::ImuSample& sample) { sample.specific_force *= 1.1; };
  GravityFinder wrong_length = drive.finder();
  EXPECT_TRUE(drive.ups(wrong_length).empty());
  EXPECT_GE(wrong_length.turned_away(), 6U);

  GravityOptions impatient;
  impatient.max_gap_s = 0.005;
  const HillyDrive good;
  GravityFinder slow_samples = good.finder(impatient);
  EXPECT_TRUE(good.ups(slow_samples).empty());
  EXPECT_GE(slow_samples.with_gaps(), 6U);

  HillyDrive lost;  // never two seconds of registered frames
  lost.disturb_frame = [](lidar::Frame& frame) { frame.health.registered = frame.index % 15 != 0; };
  GravityFinder guesses = lost.finder();
  EXPECT_TRUE(lost.ups(guesses).empty());
  EXPECT_EQ(guesses.found(), 0U);

  HillyDrive gaps;  // half a second without a scan, every two
  gaps.is_lost = [](std::size_t frame) { return frame % 20 < 5; };
  GravityFinder after_gaps = gaps.finder();
  EXPECT_TRUE(gaps.ups(after_gaps).empty());
  HillyDrive thinned;  // every other scan is enough
  thinned.is_lost = [](std::size_t frame) { return frame % 2 == 0; };
  GravityFinder at_half_rate = thinned.finder();
  for (const MeasuredUp& up : thinned.ups(at_half_rate)) EXPECT_LT(thinned.error_deg(up), 0.1);
  EXPECT_GE(at_half_rate.found(), 5U);
}

}  // namespace
}  // namespace traverse::slam
