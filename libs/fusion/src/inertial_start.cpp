#include "inertial_start.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <fmt/format.h>

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/so3.hpp"
#include "traverse/inertial/inertial_chain.hpp"
#include "traverse/inertial/stand_still.hpp"

namespace traverse::fusion {

using Eigen::Vector3d;
using geometry::seconds_between;
using inertial::NavState;
using sensors::ImuSample;

namespace {

constexpr double kRotationSigma = 0.002;  // rad, of the lidar's own pose in its own map
constexpr double kPositionSigma = 0.01;   // m

Vector3d imu_position(const Sighting& s, const Vector3d& p_lidar_imu) {
  return s.T_map_lidar * p_lidar_imu;
}

NavState state_at(const Sighting& s, const Vector3d& p_lidar_imu) {
  NavState state;
  state.stamp = s.stamp;
  state.q_map_body = s.T_map_lidar.quaternion();
  state.p_map = imu_position(s, p_lidar_imu);
  return state;
}

std::optional<FirstState> from_standing(std::span<const Sighting> sightings, const ImuReadings& imu,
                                        const Vector3d& p_lidar_imu,
                                        const InertialOdometryOptions& options) {
  constexpr double kMoved = 0.05;  // m in a second, by the lidar: it rolls evenly
  const StartOptions& start = options.start;
  const Sighting& last = sightings.back();
  const geometry::Stamp since = geometry::shifted(last.stamp, -start.stand_still.seconds);
  const auto first = std::find_if(sightings.begin(), sightings.end(),
                                  [&](const Sighting& s) { return s.stamp >= since; });
  const Vector3d way = last.T_map_lidar.translation - first->T_map_lidar.translation;
  if (way.norm() > kMoved) return std::nullopt;
  inertial::StandStillFinder finder(start.stand_still, start.gravity);
  for (const ImuSample& reading : imu.between(since, last.stamp)) finder.add(reading);
  const auto still = finder.find();
  if (!still) return std::nullopt;
  FirstState found;
  found.state = state_at(last, p_lidar_imu);
  found.state.gyro_bias = still->gyro_bias;
  found.state.accelerometer_bias = still->accelerometer_bias;
  const Vector3d up_body = still->R_level_body.row(2);
  found.gravity_map = -start.gravity * (last.T_map_lidar.rotation * up_body);
  found.sigma = inertial::first_sigma(options.wheels, kRotationSigma, kPositionSigma, 0.02,
                                      still->gyro_bias_sigma + 1e-3, start.accelerometer_bias);
  found.was_standing = true;
  found.how = fmt::format("standing still for {:g} s", start.stand_still.seconds);
  return found;
}

/// What the IMU says of the way from one sighting to the next, with the gyro's bias taken off.
struct LinkMotion {
  double seconds = 0;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Vector3d v = Vector3d::Zero();
  Vector3d p = Vector3d::Zero();
};

LinkMotion link_motion(const std::vector<ImuSample>& readings, const Vector3d& gyro_bias) {
  LinkMotion m;
  for (std::size_t i = 1; i < readings.size(); ++i) {
    const double dt = seconds_between(readings[i - 1].stamp, readings[i].stamp);
    const Vector3d turn =
        dt * (0.5 * (readings[i - 1].angular_rate + readings[i].angular_rate) - gyro_bias);
    const Vector3d force = 0.5 * (readings[i - 1].specific_force +
                                  geometry::exp_so3(turn) * readings[i].specific_force);
    m.p += dt * m.v + 0.5 * dt * dt * (m.R * force);
    m.v += dt * (m.R * force);
    m.R = m.R * geometry::exp_so3(turn);
    m.seconds += dt;
  }
  return m;
}

}  // namespace

StartVerdict find_start(std::span<const Sighting> sightings, const ImuReadings& imu,
                        const Vector3d& p_lidar_imu, const InertialOdometryOptions& options) {
  const StartOptions& start = options.start;
  const double covered =
      sightings.size() < 2 ? 0 : seconds_between(sightings.front().stamp, sightings.back().stamp);
  const double needed = std::min(start.stand_still.seconds, start.moving_s);
  if (covered < 0.9 * needed || imu.empty()) {
    return {
        {},
        fmt::format("{:.1f} s of poses by the lidar alone, {:g} s are needed", covered, needed)};
  }
  if (imu.longest_gap_s(sightings.front().stamp, sightings.back().stamp) > start.longest_gap_s) {
    return {{}, "the IMU's readings have gaps"};
  }
  if (auto standing = from_standing(sightings, imu, p_lidar_imu, options)) return {standing, ""};
  if (covered < start.moving_s) {
    return {{},
            fmt::format("in motion, and {:.1f} s of poses by the lidar alone, {:g} s are needed",
                        covered, start.moving_s)};
  }

  const std::size_t links = sightings.size() - 1;
  std::vector<std::vector<ImuSample>> readings;
  Vector3d sum_turn = Vector3d::Zero();
  double turned = 0;
  double apart = 0;
  std::vector<Vector3d> differences;
  for (std::size_t k = 0; k < links; ++k) {
    readings.push_back(imu.between(sightings[k].stamp, sightings[k + 1].stamp));
    const LinkMotion m = link_motion(readings.back(), Vector3d::Zero());
    const Eigen::Matrix3d R =
        sightings[k].T_map_lidar.rotation.transpose() * sightings[k + 1].T_map_lidar.rotation;
    differences.push_back(geometry::log_so3(m.R.transpose() * R) / m.seconds);
    sum_turn += differences.back();
    turned += geometry::log_so3(R).squaredNorm() / (m.seconds * m.seconds);
  }
  const Vector3d gyro_bias = -sum_turn / static_cast<double>(links);
  for (const Vector3d& d : differences) apart += (d + gyro_bias).squaredNorm();
  const double rate = std::sqrt(turned / static_cast<double>(links));
  const double rate_apart = std::sqrt(apart / static_cast<double>(links));
  if (gyro_bias.norm() > start.most_gyro_bias || (rate_apart > 0.1 && rate_apart > 0.5 * rate)) {
    return {{},
            fmt::format("the gyro does not turn as the lidar does: apart by {:.2g} rad/s (rms) and "
                        "{:.2g} rad/s (mean) where the lidar turns at {:.2g} rad/s; axes, unit or "
                        "clock of the IMU are wrong",
                        rate_apart, gyro_bias.norm(), rate),
            true};
  }

  // Least squares for p0, v0 and g, the axes of the map apart.
  std::vector<double> t{0};
  std::vector<Vector3d> y{imu_position(sightings[0], p_lidar_imu)};  // less the forces' integral
  Vector3d v = Vector3d::Zero();
  Vector3d p = Vector3d::Zero();
  for (std::size_t k = 0; k < links; ++k) {
    const LinkMotion m = link_motion(readings[k], gyro_bias);
    const Eigen::Matrix3d& R = sightings[k].T_map_lidar.rotation;
    p += m.seconds * v + R * m.p;
    v += R * m.v;
    t.push_back(t.back() + m.seconds);
    y.push_back(imu_position(sightings[k + 1], p_lidar_imu) - p);
  }
  const Vector3d force_velocity = v;
  const auto fit = [&](int unknowns, const std::vector<Vector3d>& values) {
    Eigen::Matrix3d N = Eigen::Matrix3d::Identity();
    Eigen::Matrix3d b = Eigen::Matrix3d::Zero();
    N.topLeftCorner(unknowns, unknowns).setZero();
    for (std::size_t k = 0; k < t.size(); ++k) {
      Vector3d a(1, t[k], 0.5 * t[k] * t[k]);
      if (unknowns < 3) a[2] = 0;
      N += a * a.transpose();
      b += a * values[k].transpose();
    }
    return Eigen::Matrix3d(N.fullPivLu().solve(b));
  };
  const Vector3d gravity_found = fit(3, y).row(2);
  if (std::abs(gravity_found.norm() - start.gravity) > start.most_gravity_error) {
    return {{},
            fmt::format("gravity by the IMU and the lidar's way is {:.2f} m/s^2, not {:.2f}: unit, "
                        "axes or clock of the IMU are wrong",
                        gravity_found.norm(), start.gravity),
            true};
  }
  FirstState found;
  found.gravity_map = start.gravity * gravity_found.normalized();
  for (std::size_t k = 0; k < t.size(); ++k) y[k] -= 0.5 * t[k] * t[k] * found.gravity_map;
  const Vector3d v0 = fit(2, y).row(1);
  found.state = state_at(sightings.back(), p_lidar_imu);
  found.state.v_map = v0 + t.back() * found.gravity_map + force_velocity;
  found.state.gyro_bias = gyro_bias;
  found.sigma = inertial::first_sigma(options.wheels, kRotationSigma, kPositionSigma, 0.1, 5e-3,
                                      start.accelerometer_bias);
  found.how = fmt::format("in motion, from {:.1f} s of poses by the lidar alone", covered);
  return {found, ""};
}

}  // namespace traverse::fusion
