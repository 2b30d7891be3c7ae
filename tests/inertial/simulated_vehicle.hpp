#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "traverse/geodesy/local_tangent_plane.hpp"
#include "traverse/geometry/so3.hpp"
#include "traverse/inertial/navigation.hpp"

namespace traverse::testing {

/// A car on an urban way with exact truth: it stands for 5 s, drives at 10 m/s with quarter turns
/// and hills, and stops at lights, where it stands still. The body is the IMU; the rear axle moves
/// only along its x axis.
class SimulatedVehicle {
 public:
  Eigen::Vector3d imu_from_axle{1.2, 0.1, 0.5};  ///< in the body
  double cruise_mps = 10;
  double light_every_s = 110;  ///< 0: no lights
  double road_scale = 1;       ///< lengths of the road, less for a small robot
  double slope_rad = 0.04;     ///< of its hills, at most

  double speed(double t) const {
    return cruise_mps * changes(t, [](double x) { return smooth(x); });
  }
  /// Along the road since the start [m].
  double way(double t) const {
    return cruise_mps * kChange * changes(t, [](double x) { return smooth_integral(x); });
  }
  // The road gives the attitude, so that a car that stands does not turn.
  double heading(double t) const {
    const double s = way(t) / road_scale;
    double sum = 0.4 + 0.03 * std::sin(0.05 * s);
    for (int k = 0; k < 40; ++k) {
      const double sign = k % 4 < 2 ? 1 : -1;
      sum += sign * M_PI / 2 * smooth((s - 120 - 230 * k) / 60);
    }
    return sum;
  }
  double pitch_up(double t) const { return slope_rad * std::sin(0.007 * way(t) / road_scale); }
  double roll(double t) const { return 0.02 * std::sin(0.031 * way(t) / road_scale); }

  Eigen::Matrix3d rotation(double t) const {
    return geometry::exp_so3({0, 0, heading(t)}) * geometry::exp_so3({0, -pitch_up(t), 0}) *
           geometry::exp_so3({roll(t), 0, 0});
  }
  Eigen::Vector3d rate(double t) const {
    constexpr double h = 1e-4;
    return geometry::log_so3(rotation(t - h).transpose() * rotation(t + h)) / (2 * h);
  }
  Eigen::Vector3d velocity(double t) const {  ///< of the IMU, in the map
    const Eigen::Matrix3d R = rotation(t);
    return R * (Eigen::Vector3d(speed(t), 0, 0) + rate(t).cross(imu_from_axle));
  }
  Eigen::Vector3d acceleration(double t) const {
    constexpr double h = 1e-3;
    return (velocity(t + h) - velocity(t - h)) / (2 * h);
  }

  /// Positions each 10 ms, by Simpson's rule on the axle's velocity.
  std::vector<Eigen::Vector3d> axle_positions(double seconds) const {
    const auto v = [&](double t) { return Eigen::Vector3d(rotation(t).col(0) * speed(t)); };
    std::vector<Eigen::Vector3d> p{Eigen::Vector3d::Zero()};
    const double h = 0.01;
    for (int k = 0; k < static_cast<int>(std::round(seconds / h)); ++k) {
      const double t = k * h;
      p.push_back(p.back() + h / 6 * (v(t) + 4 * v(t + h / 2) + v(t + h)));
    }
    return p;
  }

 private:
  static constexpr double kChange = 6;  ///< s from rest to cruise, and back

  /// The sum of `f` over the starts less that over the stops, by the share that is over of each.
  template <typename F>
  double changes(double t, const F& f) const {
    double sum = f((t - 5) / kChange);
    for (double cycle = light_every_s; light_every_s > 0 && cycle - 22 < t;
         cycle += light_every_s) {
      sum += f((t - cycle + 8) / kChange) - f((t - cycle + 22) / kChange);
    }
    return sum;
  }
  static double smooth(double x) {
    x = std::clamp(x, 0.0, 1.0);
    return x * x * x * (10 + x * (6 * x - 15));
  }
  static double smooth_integral(double x) {
    if (x > 1) return x - 0.5;
    x = std::max(x, 0.0);
    return x * x * x * x * (2.5 + x * (x - 3));
  }
};

/// What the sensors of such a car tell, with seeded noise.
struct SimulatedSensors {
  inertial::ImuNoise imu_noise{2e-4, 2e-3, 2e-6, 1e-4};
  double imu_hz = 100;
  double gyro_bias = 5e-3;  ///< standard deviation of the first
  double accelerometer_bias = 0.1;
  double gnss_hz = 10;
  double gnss_sigma_m = 0.01;    ///< horizontally; twice that in height
  double gnss_latency_s = 0;     ///< what a fix tells is so old
  double heading_sigma_deg = 0;  ///< of two antennas; 0: there is only one
  Eigen::Vector3d antenna_body{-0.3, 0.2, 0.9};
  double wheel_hz = 10;
  double wheel_offset_s = 0.03;  ///< of the readings from the fixes
  double m_per_pulse = 2 * M_PI * 0.3 / 1024;
  double wheel_scale = 1.004;        ///< true distance over told distance
  Eigen::Vector2d wheel_turn{0, 0};  ///< pitch and yaw of their axes from what is told [rad]
  std::uint32_t seed = 1;
};

/// A drive as an estimator receives it.
struct SimulatedDrive {
  std::vector<sensors::ImuSample> imu;
  std::vector<sensors::GnssFix> fixes;
  std::vector<sensors::WheelOdometry> wheels;
  std::vector<geometry::Pose3> truth;  ///< each 10 ms from t = 0, in the plane of `plane`
  std::vector<Eigen::Vector3d> velocity;
  std::vector<Eigen::Vector3d> gyro_bias, accelerometer_bias;
  inertial::Mounts mounts;
  geodesy::LocalTangentPlane plane{{48.14, 11.58, 520}};
};

inline SimulatedDrive simulate(const SimulatedVehicle& car, const SimulatedSensors& s,
                               double seconds) {
  SimulatedDrive drive;
  std::mt19937 generator(s.seed);
  std::normal_distribution<double> normal;
  const auto noise = [&](double sigma) {
    return Eigen::Vector3d{sigma * normal(generator), sigma * normal(generator),
                           sigma * normal(generator)};
  };
  const auto axle = car.axle_positions(seconds);
  const auto stamp = [](double t) { return geometry::Stamp::from_seconds(1000 + t); };
  const Eigen::Vector3d gravity(0, 0, -drive.plane.gravity());
  Eigen::Vector3d bg = noise(s.gyro_bias);
  Eigen::Vector3d ba = noise(s.accelerometer_bias);
  const double dt = 1 / s.imu_hz;
  for (std::size_t k = 0; k < axle.size(); ++k) {
    const double t = 0.01 * static_cast<double>(k);
    const Eigen::Matrix3d R = car.rotation(t);
    drive.truth.push_back({R, axle[k] + R * car.imu_from_axle});
    drive.velocity.push_back(car.velocity(t));
  }
  for (int k = 0; k * dt <= seconds; ++k) {
    const double t = k * dt;
    const Eigen::Matrix3d R = car.rotation(t);
    sensors::ImuSample sample;
    sample.stamp = stamp(t);
    sample.angular_rate = car.rate(t) + bg + noise(s.imu_noise.gyro_density / std::sqrt(dt));
    sample.specific_force = R.transpose() * (car.acceleration(t) - gravity) + ba +
                            noise(s.imu_noise.accelerometer_density / std::sqrt(dt));
    drive.imu.push_back(sample);
    drive.gyro_bias.push_back(bg);
    drive.accelerometer_bias.push_back(ba);
    bg += noise(s.imu_noise.gyro_bias_walk * std::sqrt(dt));
    ba += noise(s.imu_noise.accelerometer_bias_walk * std::sqrt(dt));
  }
  for (int k = 0; k / s.gnss_hz <= seconds; ++k) {
    const double t = k / s.gnss_hz;
    const double then = std::max(0.0, t - s.gnss_latency_s);
    const auto& T = drive.truth[static_cast<std::size_t>(std::lround(100 * then))];
    Eigen::Vector3d e = noise(s.gnss_sigma_m);
    e.z() *= 2;
    const auto place = drive.plane.to_geodetic(T * s.antenna_body + e);
    sensors::GnssFix fix;
    fix.stamp = stamp(t);
    fix.latitude_deg = place.latitude_deg;
    fix.longitude_deg = place.longitude_deg;
    fix.altitude_m = place.altitude_m;
    if (s.heading_sigma_deg > 0) {
      fix.heading_deg = 90 - car.heading(t) * 180 / M_PI + s.heading_sigma_deg * normal(generator);
    }
    drive.fixes.push_back(fix);
  }
  for (int k = 0;; ++k) {
    const double t = k / s.wheel_hz + s.wheel_offset_s;
    if (t > seconds) break;
    sensors::WheelOdometry reading;
    reading.stamp = stamp(t);
    const auto pulses =
        static_cast<std::int64_t>(std::floor(car.way(t) / s.wheel_scale / s.m_per_pulse));
    reading.ticks = {pulses, pulses};
    drive.wheels.push_back(reading);
  }
  drive.mounts.antenna_body = s.antenna_body;
  drive.mounts.wheels.p_body = -car.imu_from_axle;
  // The wheels' axes are the body's, Exp(turn) those that are told.
  drive.mounts.wheels.R_wheels_body =
      geometry::exp_so3({0, s.wheel_turn[0], s.wheel_turn[1]}).transpose();
  drive.mounts.encoder = {s.m_per_pulse, s.m_per_pulse};
  return drive;
}

/// The drive's readings to `navigation`, in the order of their stamps.
inline std::vector<inertial::NavFrame> run(inertial::Navigation& navigation,
                                           const SimulatedDrive& drive, bool with_fixes = true,
                                           bool with_wheels = true) {
  std::vector<inertial::NavFrame> frames;
  const auto collect = [&](std::vector<inertial::NavFrame> more) {
    frames.insert(frames.end(), more.begin(), more.end());
  };
  std::size_t fix = 0;
  std::size_t wheel = 0;
  for (const auto& sample : drive.imu) {
    while (with_fixes && fix < drive.fixes.size() && drive.fixes[fix].stamp <= sample.stamp &&
           (wheel == drive.wheels.size() || !with_wheels ||
            drive.fixes[fix].stamp <= drive.wheels[wheel].stamp)) {
      collect(navigation.add(drive.fixes[fix++]));
    }
    while (with_wheels && wheel < drive.wheels.size() &&
           drive.wheels[wheel].stamp <= sample.stamp) {
      collect(navigation.add(drive.wheels[wheel++]));
      while (
          with_fixes && fix < drive.fixes.size() && drive.fixes[fix].stamp <= sample.stamp &&
          (wheel == drive.wheels.size() || drive.fixes[fix].stamp <= drive.wheels[wheel].stamp)) {
        collect(navigation.add(drive.fixes[fix++]));
      }
    }
    collect(navigation.add(sample));
  }
  collect(navigation.finish());
  return frames;
}

}  // namespace traverse::testing
