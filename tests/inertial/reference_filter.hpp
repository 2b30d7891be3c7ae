#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Dense>

#include "traverse/geometry/so3.hpp"

#include "inertial/simulated_vehicle.hpp"

namespace traverse::testing {

/// A plain dense error-state Kalman filter of position, velocity, attitude, two biases and the
/// wheels' scale, to compare navigation with: what a textbook has, in one matrix of 16 x 16,
/// without windows, pre-integration, calibration or second thoughts. Its gates never open by
/// themselves. It begins, at rest, with the truth.
class ReferenceFilter {
 public:
  struct Sigmas {
    double wheel_forward_mps = 0.02;
    double wheel_side_mps = 0.02;
    bool with_wheels = true;
  };
  struct Estimate {
    double seconds;
    Eigen::Vector3d p_map;
    double heading;
  };

  ReferenceFilter(const SimulatedDrive& drive, const SimulatedSensors& sensors, Sigmas sigmas)
      : drive_(drive), sensors_(sensors), sigmas_(sigmas) {}

  /// One estimate at each fix that came, from `from_s` on.
  std::vector<Estimate> run(double from_s) {
    const std::size_t first = static_cast<std::size_t>(std::lround(from_s * sensors_.imu_hz));
    begin(first, from_s);
    std::vector<Estimate> estimates;
    std::size_t fix = 0;
    std::size_t wheel = 0;
    const auto seconds = [](geometry::Stamp stamp) { return stamp.seconds() - 1000; };
    while (fix < drive_.fixes.size() && seconds(drive_.fixes[fix].stamp) < from_s) ++fix;
    while (wheel < drive_.wheels.size() && seconds(drive_.wheels[wheel].stamp) < from_s) ++wheel;
    for (std::size_t k = first + 1; k < drive_.imu.size(); ++k) {
      predict(drive_.imu[k - 1], drive_.imu[k]);
      const double now = seconds(drive_.imu[k].stamp);
      for (; wheel < drive_.wheels.size() && seconds(drive_.wheels[wheel].stamp) <= now + 1e-6;
           ++wheel) {
        if (wheel > 0) add_wheels(wheel);
      }
      for (; fix < drive_.fixes.size() && seconds(drive_.fixes[fix].stamp) <= now + 1e-6; ++fix) {
        add_fix(drive_.fixes[fix], drive_.imu[k].angular_rate);
        estimates.push_back({now, p_, std::atan2(R_(1, 0), R_(0, 0))});
      }
    }
    return estimates;
  }

 private:
  static constexpr int kSize = 16;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  enum { kP = 0, kV = 3, kR = 6, kG = 9, kA = 12, kS = 15 };

  void begin(std::size_t sample, double from_s) {
    const auto& T = drive_.truth[static_cast<std::size_t>(std::lround(100 * from_s))];
    p_ = T.translation;
    R_ = T.rotation;
    v_.setZero();
    bg_.setZero();
    ba_.setZero();
    for (std::size_t k = 0; k < sample; ++k) {
      bg_ += drive_.imu[k].angular_rate / static_cast<double>(sample);
    }
    P_.setZero();
    P_.diagonal().segment<3>(kP).setConstant(1e-2);
    P_.diagonal().segment<3>(kV).setConstant(1e-4);
    P_.diagonal().segment<3>(kR).setConstant(1e-4);
    P_.diagonal().segment<3>(kG).setConstant(1e-6);
    P_.diagonal().segment<3>(kA).setConstant(4e-2);
    P_(kS, kS) = 4e-4;
  }

  void predict(const sensors::ImuSample& a, const sensors::ImuSample& b) {
    const double dt = geometry::seconds_between(a.stamp, b.stamp);
    const Eigen::Vector3d turn = dt * (0.5 * (a.angular_rate + b.angular_rate) - bg_);
    const Eigen::Matrix3d before = R_;
    R_ = R_ * geometry::exp_so3(turn);
    const Eigen::Vector3d gravity(0, 0, -drive_.plane.gravity());
    const Eigen::Vector3d force =
        0.5 * (before * (a.specific_force - ba_) + R_ * (b.specific_force - ba_));
    const Eigen::Vector3d dv = dt * (force + gravity);
    p_ += dt * (v_ + 0.5 * dv);
    v_ += dv;
    way_m_ += dt * forward();
    Matrix F = Matrix::Identity();
    F.block<3, 3>(kP, kV) = dt * Eigen::Matrix3d::Identity();
    F.block<3, 3>(kV, kR) = -dt * R_ * geometry::hat(b.specific_force - ba_);
    F.block<3, 3>(kV, kA) = -dt * R_;
    F.block<3, 3>(kR, kR) = geometry::exp_so3(-turn);
    F.block<3, 3>(kR, kG) = -dt * Eigen::Matrix3d::Identity();
    P_ = F * P_ * F.transpose();
    const auto& n = sensors_.imu_noise;
    const auto add = [&](int part, double density) {
      P_.diagonal().segment<3>(part).array() += density * density * dt;
    };
    add(kV, n.accelerometer_density);
    add(kR, n.gyro_density);
    add(kG, n.gyro_bias_walk);
    add(kA, n.accelerometer_bias_walk);
    rate_ = b.angular_rate;
  }

  Eigen::Vector3d at_axle() const {
    return R_.transpose() * v_ + (rate_ - bg_).cross(drive_.mounts.wheels.p_body);
  }
  double forward() const { return at_axle().x(); }

  template <int N>
  void update(const Eigen::Matrix<double, N, 1>& r, const Eigen::Matrix<double, N, kSize>& H,
              const Eigen::Matrix<double, N, 1>& sigma) {
    static constexpr double kBounds[] = {0, 10.828, 13.816, 16.266};
    Eigen::Matrix<double, N, N> S = H * P_ * H.transpose();
    S.diagonal() += sigma.cwiseAbs2();
    const Eigen::Matrix<double, N, N> S_inverse = S.inverse();
    if (r.dot(S_inverse * r) > kBounds[N]) return;
    const Eigen::Matrix<double, kSize, N> K = P_ * H.transpose() * S_inverse;
    const Eigen::Matrix<double, kSize, 1> d = K * r;
    p_ += d.template segment<3>(kP);
    v_ += d.template segment<3>(kV);
    R_ = R_ * geometry::exp_so3(Eigen::Vector3d(d.template segment<3>(kR)));
    bg_ += d.template segment<3>(kG);
    ba_ += d.template segment<3>(kA);
    scale_ += d[kS];
    const Matrix I_KH = Matrix::Identity() - K * H;
    P_ = I_KH * P_ * I_KH.transpose() + K * sigma.cwiseAbs2().asDiagonal() * K.transpose();
  }

  void add_fix(const sensors::GnssFix& fix, const Eigen::Vector3d& rate) {
    rate_ = rate;
    const Eigen::Vector3d z =
        drive_.plane.to_enu({fix.latitude_deg, fix.longitude_deg, fix.altitude_m});
    Eigen::Matrix<double, 3, kSize> H = Eigen::Matrix<double, 3, kSize>::Zero();
    H.block<3, 3>(0, kP).setIdentity();
    H.block<3, 3>(0, kR) = -R_ * geometry::hat(drive_.mounts.antenna_body);
    const double s = sensors_.gnss_sigma_m;
    update<3>(z - p_ - R_ * drive_.mounts.antenna_body, H, Eigen::Vector3d(s, s, 2 * s));
    if (!fix.heading_deg) return;
    const double told = (90 - *fix.heading_deg) * M_PI / 180;
    const double c = R_(0, 0) * R_(0, 0) + R_(1, 0) * R_(1, 0);
    Eigen::Matrix<double, 1, kSize> h = Eigen::Matrix<double, 1, kSize>::Zero();
    h(0, kR + 1) = -(R_(0, 0) * R_(1, 2) - R_(1, 0) * R_(0, 2)) / c;
    h(0, kR + 2) = (R_(0, 0) * R_(1, 1) - R_(1, 0) * R_(0, 1)) / c;
    using One = Eigen::Matrix<double, 1, 1>;
    update<1>(One(std::remainder(told - std::atan2(R_(1, 0), R_(0, 0)), 2 * M_PI)), h,
              One(sensors_.heading_sigma_deg * M_PI / 180));
  }

  /// The mean speed that pulses tell against the mean of what was predicted for the same time.
  void add_wheels(std::size_t k) {
    const double way = way_m_;
    way_m_ = 0;
    const double since =
        last_wheel_ ? geometry::seconds_between(*last_wheel_, drive_.wheels[k].stamp) : 0;
    last_wheel_ = drive_.wheels[k].stamp;
    if (!sigmas_.with_wheels || !(since > 0)) return;
    const auto pulses = [&](std::size_t i) {
      return static_cast<double>(drive_.wheels[i].ticks->left + drive_.wheels[i].ticks->right) / 2;
    };
    const double told = (pulses(k) - pulses(k - 1)) * sensors_.m_per_pulse / since;
    const Eigen::Vector3d v_axle = at_axle();
    // The time of IMU readings that are not a wheel's time differs by less than one of them.
    const Eigen::Vector3d r(scale_ * told - way / since, -v_axle.y(), -v_axle.z());
    Eigen::Matrix<double, 3, kSize> H = Eigen::Matrix<double, 3, kSize>::Zero();
    H.block<3, 3>(0, kV) = R_.transpose();
    H.block<3, 3>(0, kR) = geometry::hat(R_.transpose() * v_);
    H.block<3, 3>(0, kG) = geometry::hat(drive_.mounts.wheels.p_body);
    H(0, kS) = -told;
    const double side = sigmas_.wheel_side_mps;
    update<3>(r, H, Eigen::Vector3d(sigmas_.wheel_forward_mps, side, side));
  }

  const SimulatedDrive& drive_;
  const SimulatedSensors& sensors_;
  Sigmas sigmas_;
  Eigen::Vector3d p_, v_, bg_, ba_, rate_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_;
  double scale_ = 1;
  double way_m_ = 0;
  std::optional<geometry::Stamp> last_wheel_;
  Matrix P_;
};

}  // namespace traverse::testing
