#include "traverse/simulation/vehicle_motion.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/so3.hpp"

#include "speed_plan.hpp"

namespace traverse::simulation {

using config::Range;
using geometry::Pose3;

namespace {

constexpr std::size_t kTiltControlEvery = 5;  ///< samples of the speed plan: 0.1 s
constexpr double kSlowestPace = 0.85;         ///< of other drivers, shares of the route's speed
constexpr double kFastestPace = 1.1;

/// A damped oscillator that follows a demand, driven step by step.
class Oscillator {
 public:
  Oscillator(double natural_hz, double damping)
      : omega_(2 * std::numbers::pi * natural_hz), damping_(damping) {}

  double follow(double demand, double dt) {
    rate_ += dt * (omega_ * omega_ * (demand - angle_) - 2 * damping_ * omega_ * rate_);
    angle_ += dt * rate_;
    return angle_;
  }

 private:
  double omega_, damping_;
  double angle_ = 0;
  double rate_ = 0;
};

JetVector cross(const JetVector& a, const JetVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

JetVector normalised(const JetVector& a) {
  const Jet scale = inverse(sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]));
  return {scale * a[0], scale * a[1], scale * a[2]};
}

JetMatrix pitch_then_roll(const Jet& pitch, const Jet& roll) {
  JetMatrix about_y, about_x;
  about_y << cos(pitch), Jet(0), sin(pitch), Jet(0), Jet(1), Jet(0), -sin(pitch), Jet(0),
      cos(pitch);
  about_x << Jet(1), Jet(0), Jet(0), Jet(0), cos(roll), -sin(roll), Jet(0), sin(roll), cos(roll);
  return about_y * about_x;
}

/// The route as another driver takes it.
RouteSettings at_a_pace_of_its_own(RouteSettings route, std::optional<std::uint64_t> other_drive) {
  if (!other_drive) return route;
  std::mt19937_64 generator(*other_drive);
  route.speed_mps *= std::uniform_real_distribution<double>(kSlowestPace, kFastestPace)(generator);
  return route;
}

Eigen::Vector3d vee(const Eigen::Matrix3d& m) {
  return 0.5 * Eigen::Vector3d(m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1));
}

}  // namespace

void bind(config::Binder& b, SuspensionSettings& s) {
  b.number("roll_deg_per_mps2", s.roll_deg_per_mps2, Range::between(0, 5),
           "roll out of a corner by lateral acceleration");
  b.number("pitch_deg_per_mps2", s.pitch_deg_per_mps2, Range::between(0, 5),
           "pitch by acceleration, nose down when braking");
  b.number("natural_hz", s.natural_hz, Range::between(0.2, 3), "of roll and pitch");
  b.number("damping", s.damping, Range::between(0.05, 2), "share of the critical damping");
  b.number("roughness_deg", s.roughness_deg, Range::between(0, 5),
           "rms of roll and pitch from the road at full speed");
}

void bind(config::Binder& b, GaitSettings& g) {
  b.number("turn_deg", g.turn_deg, Range::between(0, 170),
           "amplitude of looking left and right of the way");
  b.number("turn_hz", g.turn_hz, Range::between(0.05, 2), "how often");
  b.number("step_hz", g.step_hz, Range::between(0.5, 2), "steps a second");
  b.number("bob_m", g.bob_m, Range::between(0, 0.2), "amplitude of up and down, once a step");
  b.number("sway_m", g.sway_m, Range::between(0, 0.2),
           "amplitude of left and right, once in two steps");
  b.number("tilt_deg", g.tilt_deg, Range::between(0, 30),
           "amplitude of pitch, once a step, and of roll, once in two");
}

MotionState MotionState::at(const Pose3& T_body_sensor) const {
  const Eigen::Matrix3d& R = T_map_body.rotation;
  const Eigen::Vector3d& arm = T_body_sensor.translation;
  const Eigen::Vector3d& w = angular_rate_body;
  MotionState sensor;
  sensor.T_map_body = T_map_body * T_body_sensor;
  sensor.velocity_map = velocity_map + R * w.cross(arm);
  sensor.acceleration_map =
      acceleration_map + R * (angular_acceleration_body.cross(arm) + w.cross(w.cross(arm)));
  sensor.angular_rate_body = T_body_sensor.rotation.transpose() * w;
  sensor.angular_acceleration_body = T_body_sensor.rotation.transpose() * angular_acceleration_body;
  return sensor;
}

Pose3 MotionState::pose_after(double seconds) const {
  Pose3 pose;
  pose.rotation =
      T_map_body.rotation *
      geometry::exp_so3(seconds * (angular_rate_body + 0.5 * seconds * angular_acceleration_body));
  pose.translation =
      T_map_body.translation + seconds * (velocity_map + 0.5 * seconds * acceleration_map);
  return pose;
}

VehicleMotion::VehicleMotion(const RouteSettings& route, const SuspensionSettings& suspension,
                             const Terrain& terrain, std::uint64_t seed,
                             std::optional<std::uint64_t> other_drive, const GaitSettings& gait)
    : route_(route, other_drive),
      terrain_(terrain),
      is_carried_(gait.turn_deg > 0 || gait.bob_m > 0 || gait.sway_m > 0 || gait.tilt_deg > 0) {
  const SpeedPlan plan = plan_speed(route_, at_a_pace_of_its_own(route, other_drive));
  const std::vector<double>& s = plan.progress_m;
  constexpr double dt = SpeedPlan::kStep;

  Oscillator roll(suspension.natural_hz, suspension.damping);
  Oscillator pitch(suspension.natural_hz, suspension.damping);
  std::mt19937_64 generator(other_drive.value_or(seed));
  std::normal_distribution<double> bump(0, suspension.roughness_deg * 4);
  std::vector<double> progress_controls, roll_controls, pitch_controls;
  std::vector<double> turn_controls, bob_controls, sway_controls;
  double roll_bump = 0;
  double pitch_bump = 0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const double before = s[i > 0 ? i - 1 : i];
    const double after = s[i + 1 < s.size() ? i + 1 : i];
    const double speed = (after - before) / (2 * dt);
    const double acceleration = (after - 2 * s[i] + before) / (dt * dt);
    const double lateral = speed * speed * route_.curvature(s[i]);
    if (i % kTiltControlEvery == 0) {
      roll_bump = bump(generator) * speed / route.speed_mps;
      pitch_bump = bump(generator) * speed / route.speed_mps;
    }
    const double roll_now =
        roll.follow((suspension.roll_deg_per_mps2 * lateral + roll_bump) * geometry::kDegree, dt);
    const double pitch_now = pitch.follow(
        (-suspension.pitch_deg_per_mps2 * acceleration + pitch_bump) * geometry::kDegree, dt);
    if (i % kTiltControlEvery != 0) continue;
    progress_controls.push_back(s[i]);
    const double share = speed / route.speed_mps;
    const auto swing = [&](double amplitude, double hz) {
      return share * amplitude * std::sin(2 * std::numbers::pi * hz * static_cast<double>(i) * dt);
    };
    const double tilt = gait.tilt_deg * geometry::kDegree;
    roll_controls.push_back(is_carried_ ? roll_now + swing(tilt, 0.5 * gait.step_hz) : roll_now);
    pitch_controls.push_back(is_carried_ ? pitch_now + swing(tilt, gait.step_hz) : pitch_now);
    turn_controls.push_back(swing(gait.turn_deg * geometry::kDegree, gait.turn_hz));
    bob_controls.push_back(swing(gait.bob_m, gait.step_hz));
    sway_controls.push_back(swing(gait.sway_m, 0.5 * gait.step_hz));
  }
  duration_s_ = dt * static_cast<double>(s.size() - 1);
  constexpr double step = dt * static_cast<double>(kTiltControlEvery);
  const auto ends = UniformSpline::Ends::kConstant;
  progress_ = UniformSpline(std::move(progress_controls), step, ends);
  roll_ = UniformSpline(std::move(roll_controls), step, ends);
  pitch_ = UniformSpline(std::move(pitch_controls), step, ends);
  turn_ = UniformSpline(std::move(turn_controls), step, ends);
  bob_ = UniformSpline(std::move(bob_controls), step, ends);
  sway_ = UniformSpline(std::move(sway_controls), step, ends);
}

Jet VehicleMotion::progress(double seconds) const { return progress_(Jet(seconds, 1, 0)); }

MotionState VehicleMotion::state(double seconds) const {
  const Jet time(seconds, 1, 0);
  const Route::Place place = route_.at(progress_(time));
  const Terrain::Surface ground = terrain_.surface(place.x, place.y);

  // The wheels stand on the ground's tangent plane and roll along the route's tangent.
  const JetVector ahead =
      normalised({place.tangent_x, place.tangent_y,
                  ground.slope_x * place.tangent_x + ground.slope_y * place.tangent_y});
  const JetVector up = normalised({-ground.slope_x, -ground.slope_y, Jet(1)});
  JetMatrix on_wheels;
  on_wheels.col(0) = ahead;
  on_wheels.col(1) = cross(up, ahead);
  on_wheels.col(2) = up;
  JetMatrix R = on_wheels * pitch_then_roll(pitch_(time), roll_(time));
  JetVector p(place.x, place.y, ground.height);
  if (is_carried_) {
    const Jet turn = turn_(time);
    JetMatrix about_z;
    about_z << cos(turn), -sin(turn), Jet(0), sin(turn), cos(turn), Jet(0), Jet(0), Jet(0), Jet(1);
    R = on_wheels * about_z * pitch_then_roll(pitch_(time), roll_(time));
    p += on_wheels.col(1) * sway_(time) + on_wheels.col(2) * bob_(time);
  }

  const Eigen::Matrix3d R0 = values(R);
  const Eigen::Matrix3d R1 = rates(R);
  MotionState state;
  state.T_map_body.rotation = R0;
  state.T_map_body.translation = values(p);
  state.velocity_map = rates(p);
  state.acceleration_map = bends(p);
  state.angular_rate_body = vee(R0.transpose() * R1);
  state.angular_acceleration_body = vee(R1.transpose() * R1 + R0.transpose() * bends(R));
  return state;
}

}  // namespace traverse::simulation
