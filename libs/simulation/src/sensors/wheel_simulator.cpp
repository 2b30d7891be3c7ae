#include "traverse/simulation/wheel_simulator.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace traverse::simulation {

using config::Range;

namespace {

constexpr std::uint64_t kConstant = ~std::uint64_t{0};  ///< place of what is drawn once

}  // namespace

void bind(config::Binder& b, WheelSettings& s) {
  b.flag("mounted", s.mounted, "the vehicle counts its wheels' pulses");
  b.number("rate_hz", s.rate_hz, Range::between(1, 1000), "samples per second");
  b.number("radius_m", s.radius_m, Range::between(0.02, 2), "of the wheels, nominal");
  b.number("track_m", s.track_m, Range::between(0.05, 5), "between the wheels");
  b.number("pulses_per_turn", s.pulses_per_turn, Range::between(1, 1e6), "of each wheel");
  b.number("radius_error", s.radius_error, Range::between(0, 0.2), "standard deviation, relative");
  b.number("slip_per_mps2", s.slip_per_mps2, Range::between(0, 0.2),
           "slip of a wheel, share per m/s^2 of acceleration");
  b.number("roughness", s.roughness, Range::between(0, 0.5),
           "standard deviation of the distance, relative");
}

WheelSimulator::WheelSimulator(const WheelSettings& settings, const VehicleMotion& motion,
                               std::uint64_t seed)
    : settings_(settings), motion_(motion), noise_(seed, 3) {
  const CounterNoise::Draw draw = noise_.at(kConstant);
  left_radius_ = settings.radius_m * (1 + settings.radius_error * draw.gaussian_1);
  right_radius_ = settings.radius_m * (1 + settings.radius_error * draw.gaussian_2);
}

/// Boole's rule over the speeds of the wheels along the body.
WheelSimulator::Ways WheelSimulator::exact_ways(double from_s, double to_s) const {
  constexpr std::array<double, 5> kWeights{7, 32, 12, 32, 7};
  Ways ways{0, 0};
  const double step = (to_s - from_s) / 4;
  for (std::size_t i = 0; i < kWeights.size(); ++i) {
    const MotionState state = motion_.state(from_s + step * static_cast<double>(i));
    const double forward = state.T_map_body.rotation.col(0).dot(state.velocity_map);
    const double turning = state.angular_rate_body.z() * settings_.track_m / 2;
    const double weight = kWeights[i] / 90 * (to_s - from_s);
    ways.left += weight * (forward - turning);
    ways.right += weight * (forward + turning);
  }
  return ways;
}

sensors::WheelOdometry WheelSimulator::next() {
  const double now = static_cast<double>(count_) / settings_.rate_hz;
  if (count_ > 0) {
    const double before = static_cast<double>(count_ - 1) / settings_.rate_hz;
    const Ways ways = exact_ways(before, now);
    const MotionState state = motion_.state(0.5 * (before + now));
    const double pull = state.T_map_body.rotation.col(0).dot(state.acceleration_map);
    const double slip = settings_.slip_per_mps2 * pull;
    const CounterNoise::Draw draw = noise_.at(count_);
    const double turn = 2 * std::numbers::pi;
    left_turns_ +=
        ways.left * (1 + slip + settings_.roughness * draw.gaussian_1) / (turn * left_radius_);
    right_turns_ +=
        ways.right * (1 + slip + settings_.roughness * draw.gaussian_2) / (turn * right_radius_);
  }
  sensors::WheelOdometry odometry;
  odometry.stamp = geometry::Stamp::from_seconds(now);
  reckon(static_cast<std::int64_t>(std::floor(left_turns_ * settings_.pulses_per_turn)),
         static_cast<std::int64_t>(std::floor(right_turns_ * settings_.pulses_per_turn)), odometry);
  ++count_;
  return odometry;
}

void WheelSimulator::reckon(std::int64_t left, std::int64_t right,
                            sensors::WheelOdometry& odometry) {
  const double metres_per_pulse =
      2 * std::numbers::pi * settings_.radius_m / settings_.pulses_per_turn;
  const double left_m = static_cast<double>(left - ticks_.left) * metres_per_pulse;
  const double right_m = static_cast<double>(right - ticks_.right) * metres_per_pulse;
  geometry::Twist step;
  step << 0, 0, (right_m - left_m) / settings_.track_m, 0.5 * (left_m + right_m), 0, 0;
  T_odom_body_ = (T_odom_body_ * geometry::exp_se3(step)).orthonormalised();
  ticks_ = {left, right};
  odometry.ticks = ticks_;
  odometry.T_odom_body = T_odom_body_;
  odometry.velocity = {step[3] * settings_.rate_hz, 0, step[2] * settings_.rate_hz};
}

}  // namespace traverse::simulation
