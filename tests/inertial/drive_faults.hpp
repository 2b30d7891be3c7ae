#pragma once

#include <cstdint>
#include <functional>
#include <random>

#include "inertial/simulated_vehicle.hpp"

/// What goes wrong on drives, done to a SimulatedDrive.
namespace traverse::testing {

inline double seconds_of(geometry::Stamp stamp) { return stamp.seconds() - 1000; }

/// Counts the pulses anew, each interval from `from_s` for `seconds` times `left` and `right`: zero
/// for wheels that lock, more than one for wheels that spin.
inline void slip(SimulatedDrive& drive, double from_s, double seconds, double left, double right) {
  sensors::WheelOdometry::Ticks before = *drive.wheels.front().ticks;
  sensors::WheelOdometry::Ticks sum = before;
  for (std::size_t k = 1; k < drive.wheels.size(); ++k) {
    auto& ticks = *drive.wheels[k].ticks;
    const double t = seconds_of(drive.wheels[k].stamp);
    const bool slips = t > from_s && t <= from_s + seconds;
    const auto pulses = [&](std::int64_t now, std::int64_t then, double factor) {
      return slips ? std::llround(factor * static_cast<double>(now - then)) : now - then;
    };
    const sensors::WheelOdometry::Ticks told = ticks;
    sum.left += pulses(told.left, before.left, left);
    sum.right += pulses(told.right, before.right, right);
    before = told;
    ticks = sum;
  }
}

inline void remove_fixes(SimulatedDrive& drive, double from_s, double seconds) {
  std::erase_if(drive.fixes, [&](const sensors::GnssFix& fix) {
    const double t = seconds_of(fix.stamp);
    return t > from_s && t <= from_s + seconds;
  });
}

/// One heading in `one_in` is any angle, and said to be valid as the others.
inline void spoil_headings(SimulatedDrive& drive, int one_in, std::uint32_t seed = 5) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> angle(0, 360);
  for (auto& fix : drive.fixes) {
    const bool is_wrong = generator() % static_cast<std::uint32_t>(one_in) == 0;
    const double wrong = angle(generator);
    if (is_wrong) fix.heading_deg = wrong;
  }
}

/// Headings are valid only where the vehicle is faster than that.
inline void keep_headings_above(SimulatedDrive& drive, double mps) {
  for (auto& fix : drive.fixes) {
    const auto k = static_cast<std::size_t>(std::lround(100 * seconds_of(fix.stamp)));
    if (drive.velocity[k].norm() < mps) fix.heading_deg.reset();
  }
}

/// The receiver goes over to float ambiguities about every `every_s` for `lasts_s`: all fixes are
/// then off by one step of `step_m`, twice that in height.
inline void step_fixes(SimulatedDrive& drive, double step_m, double every_s, double lasts_s,
                       std::uint32_t seed = 3) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.5, 1.5);
  double begin = every_s * uniform(generator);
  double end = begin + lasts_s * uniform(generator);
  const auto draw = [&] {
    const double east = normal(generator);
    const double north = normal(generator);
    const double up = normal(generator);
    return Eigen::Vector3d(step_m * east, step_m * north, 2 * step_m * up);
  };
  Eigen::Vector3d step = draw();
  for (auto& fix : drive.fixes) {
    const double t = seconds_of(fix.stamp);
    if (t > end) {
      begin = t + every_s * uniform(generator);
      end = begin + lasts_s * uniform(generator);
      step = draw();
    }
    if (t < begin) continue;
    const Eigen::Vector3d p =
        drive.plane.to_enu({fix.latitude_deg, fix.longitude_deg, fix.altitude_m});
    const auto off = drive.plane.to_geodetic(p + step);
    fix.latitude_deg = off.latitude_deg;
    fix.longitude_deg = off.longitude_deg;
    fix.altitude_m = off.altitude_m;
  }
}

/// The IMU shakes while the vehicle drives, white, as on a small robot.
inline void shake(SimulatedDrive& drive, double force, double rate, std::uint32_t seed = 9) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  for (std::size_t k = 0; k < drive.imu.size(); ++k) {
    if (drive.velocity[std::min(k, drive.velocity.size() - 1)].norm() < 0.05) continue;
    for (int axis = 0; axis < 3; ++axis) {
      drive.imu[k].specific_force[axis] += force * normal(generator);
      drive.imu[k].angular_rate[axis] += rate * normal(generator);
    }
  }
}

}  // namespace traverse::testing
