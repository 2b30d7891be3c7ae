#include "traverse/simulation/gnss_simulator.hpp"

#include <GeographicLib/LocalCartesian.hpp>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

namespace traverse::simulation {

using config::Range;
using Eigen::Vector3d;

namespace {

constexpr double kLeastSky = 0.2;
constexpr double kSlow = 90;  ///< seconds over which atmospheric and clock errors wander
constexpr double kFast = 4;   ///< the same for reflections off buildings

/// One step of a Gauss-Markov process of unit variance.
void wander(Vector3d& state, double step_s, double correlation_s, const Vector3d& draw) {
  const double keep = std::exp(-step_s / correlation_s);
  state = keep * state + std::sqrt(1 - keep * keep) * draw;
}

}  // namespace

struct GnssSimulator::Plane {
  GeographicLib::LocalCartesian at_origin;
};

void bind(config::Binder& b, GnssSettings& s) {
  static constexpr std::array<std::pair<std::string_view, GnssMode>, 3> kModes{
      {{"rtk", GnssMode::kRtk},
       {"standard", GnssMode::kStandard},
       {"multipath", GnssMode::kMultipath}}};
  b.flag("mounted", s.mounted, "the vehicle has a receiver");
  bind(b, s.mounting);
  b.choice("mode", s.mode, kModes, "quality of its positions");
  b.number("rate_hz", s.rate_hz, Range::between(0.1, 100), "fixes per second");
  b.flag("dual_antenna", s.dual_antenna, "it gives headings");
  b.number("heading_noise_deg", s.heading_noise_deg, Range::between(0, 90), "standard deviation");
  b.number("heading_from_mps", s.heading_from_mps, Range::non_negative(),
           "speed from which on it gives headings");
  b.number("step_m", s.step_m, Range::non_negative(),
           "standard deviation of the steps by which positions are off for a few seconds");
  b.number("steps_every_s", s.steps_every_s, Range::positive(), "mean time between two steps");
  b.number("step_s", s.step_s, Range::positive(), "mean time that a step lasts");
  b.numbers("outages_s", s.outages_s, "begin and end of each outage in turn, seconds of the drive");
  b.number("latitude_deg", s.latitude_deg, Range::between(-89, 89), "of the map's origin");
  b.number("longitude_deg", s.longitude_deg, Range::between(-180, 180), "of the map's origin");
  b.number("altitude_m", s.altitude_m, Range::between(-500, 9000), "above the ellipsoid");
}

GnssSimulator::GnssSimulator(const GnssSettings& settings, const Surroundings& surroundings,
                             const VehicleMotion& motion, std::uint64_t seed)
    : settings_(settings),
      surroundings_(surroundings),
      motion_(motion),
      T_body_antenna_(settings.mounting.T_body_sensor()),
      noise_(seed, 4),
      plane_(std::make_unique<Plane>(Plane{GeographicLib::LocalCartesian(
          settings.latitude_deg, settings.longitude_deg, settings.altitude_m)})) {}

GnssSimulator::~GnssSimulator() = default;

Vector3d GnssSimulator::geodetic(const Vector3d& p_map) const {
  Vector3d result;
  plane_->at_origin.Reverse(p_map.x(), p_map.y(), p_map.z(), result.x(), result.y(), result.z());
  return result;
}

bool GnssSimulator::is_out(double seconds) const {
  for (std::size_t i = 0; i + 1 < settings_.outages_s.size(); i += 2) {
    if (seconds >= settings_.outages_s[i] && seconds < settings_.outages_s[i + 1]) return true;
  }
  return false;
}

Vector3d GnssSimulator::error(std::size_t i, double open_sky, Vector3d& deviation) {
  Vector3d white, slow, fast;
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const CounterNoise::Draw a = noise_.at(i, axis);
    white[axis] = a.gaussian_1;
    slow[axis] = a.gaussian_2;
    fast[axis] = noise_.at(i, 3 + axis).gaussian_1;
  }
  wander(slow_, 1 / settings_.rate_hz, kSlow, slow);
  wander(fast_, 1 / settings_.rate_hz, kFast, fast);

  const Vector3d shape(1, 1, 1.8);  // heights are worse
  double of_white = 0.3, of_slow = 1.2, of_fast = 0;
  if (settings_.mode == GnssMode::kRtk) {
    const bool is_fixed = open_sky > 0.5;
    of_white = is_fixed ? 0.01 : 0.1;
    of_slow = is_fixed ? 0.008 : 0.3;
  } else if (settings_.mode == GnssMode::kMultipath) {
    of_fast = 6 * (1 - open_sky);
  }
  deviation = shape * std::sqrt(of_white * of_white + of_slow * of_slow + of_fast * of_fast);
  return shape.cwiseProduct(of_white * white + of_slow * slow_ + of_fast * fast_);
}

/// The step that positions are off by at sample `i`: it comes and goes as a coin says.
Vector3d GnssSimulator::step(std::size_t i) {
  constexpr std::uint32_t kOfSteps = 8;
  if (!(settings_.step_m > 0)) return step_;
  const CounterNoise::Draw a = noise_.at(i, kOfSteps);
  const CounterNoise::Draw b = noise_.at(i, kOfSteps + 1);
  const bool is_off = !step_.isZero();
  const double mean_s = is_off ? settings_.step_s : settings_.steps_every_s;
  if (a.uniform_1 > 1 / (mean_s * settings_.rate_hz)) return step_;
  step_ = is_off
              ? Vector3d(Vector3d::Zero())
              : Vector3d(settings_.step_m * Vector3d(b.gaussian_1, b.gaussian_2, 2 * a.gaussian_1));
  return step_;
}

std::optional<sensors::GnssFix> GnssSimulator::sample(std::size_t i) {
  const double seconds = static_cast<double>(i) / settings_.rate_hz;
  const MotionState antenna = motion_.state(seconds).at(T_body_antenna_);
  const double open_sky = surroundings_.open_sky(antenna.T_map_body.translation);
  Vector3d deviation;
  const Vector3d wrong = error(i, open_sky, deviation) + step(i);  // wanders on during outages
  if (is_out(seconds) || open_sky < kLeastSky) return std::nullopt;

  sensors::GnssFix fix;
  fix.stamp = geometry::Stamp::from_seconds(seconds);
  const Vector3d position = geodetic(antenna.T_map_body.translation + wrong);
  fix.latitude_deg = position.x();
  fix.longitude_deg = position.y();
  fix.altitude_m = position.z();
  fix.covariance_enu = deviation.cwiseAbs2().asDiagonal();
  const bool drives = antenna.velocity_map.norm() >= settings_.heading_from_mps;
  if (settings_.dual_antenna && drives) {
    const Vector3d ahead = antenna.T_map_body.rotation.col(0);
    const double from_north = std::atan2(ahead.x(), ahead.y()) * 180 / std::numbers::pi;
    const double heading = from_north + settings_.heading_noise_deg * noise_.at(i, 6).gaussian_1;
    fix.heading_deg = std::fmod(heading + 720, 360);
  }
  return fix;
}

}  // namespace traverse::simulation
