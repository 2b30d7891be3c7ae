#include "traverse/simulation/lidar_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "traverse/geometry/angle.hpp"

namespace traverse::simulation {

using Eigen::Vector3d;

namespace {

constexpr std::size_t kColumns = 8;  ///< firings that are cast together: neighbours in azimuth

void require_beams(const std::vector<double>& values, std::size_t beams, const char* key) {
  if (values.empty() || values.size() == beams) return;
  throw std::invalid_argument(
      fmt::format("{}: expected {} numbers, one a beam, found {}", key, beams, values.size()));
}

/// A sweep is held in memory.
void require_reasonable(const sensors::LidarProfile& profile, std::size_t beams, double period_s) {
  constexpr double kShortestSweep_s = 1e-3;
  constexpr double kLongestSweep_s = 1e3;
  constexpr double kMostRays = 1 << 22;
  if (!(profile.sweep_s >= kShortestSweep_s && profile.sweep_s <= kLongestSweep_s)) {
    throw std::invalid_argument(fmt::format("sweep_s: expected {:g} to {:g} s, found {:g}",
                                            kShortestSweep_s, kLongestSweep_s, profile.sweep_s));
  }
  const double rays = profile.sweep_s / period_s * static_cast<double>(beams);
  if (!(rays <= kMostRays)) {
    throw std::invalid_argument(
        fmt::format("firing.period_us: expected at most {:.0f} rays a sweep, found {:g} ({} beams, "
                    "{:g} firings)",
                    kMostRays, rays, beams, profile.sweep_s / period_s));
  }
}

}  // namespace

/// Rays of some firings, those of a beam side by side: index is beam * kColumns + column.
struct LidarSimulator::Block {
  std::vector<Ray> rays;
  std::vector<Vector3d> directions_lidar;
  std::vector<double> seconds;
  std::vector<SurfaceHit> hits;

  explicit Block(std::size_t beams)
      : rays(beams * kColumns),
        directions_lidar(beams * kColumns),
        seconds(beams * kColumns),
        hits(beams * kColumns) {}
};

LidarSimulator::LidarSimulator(const sensors::LidarProfile& profile,
                               const geometry::Pose3& T_body_lidar,
                               const Surroundings& surroundings, const VehicleMotion& motion,
                               std::uint64_t seed)
    : profile_(profile),
      T_body_lidar_(T_body_lidar),
      surroundings_(surroundings),
      motion_(motion),
      noise_(seed, 1),
      period_s_(profile.firing.period_us * 1e-6),
      turn_rate_((profile.rotation == sensors::Rotation::kClockwise ? -1 : 1) * 2 *
                 std::numbers::pi / profile.sweep_s) {
  const sensors::NoddingMirror& mirror = profile.firing.mirror;
  has_mirror_ = mirror.turns_hz > 0;
  if (has_mirror_) turn_rate_ *= mirror.turns_hz * profile.sweep_s;
  const std::size_t count = has_mirror_ ? mirror.tilts_deg.size() : profile.elevations_deg.size();
  if (count == 0) {
    throw std::invalid_argument(std::string(has_mirror_ ? "firing.mirror.tilts" : "elevations") +
                                "_deg: expected one a beam, found none");
  }
  if (!(period_s_ > 0 && period_s_ <= profile.sweep_s)) {
    throw std::invalid_argument(
        fmt::format("firing.period_us: expected the time between two firings, found {:g}",
                    profile.firing.period_us));
  }
  require_reasonable(profile, count, period_s_);
  require_beams(profile.firing.times_us, count, "firing.times_us");
  require_beams(profile.firing.azimuth_offsets_deg, count, "firing.azimuth_offsets_deg");
  for (std::size_t i = 0; i < count; ++i) {
    const auto& firing = profile.firing;
    const double after_s = firing.times_us.empty() ? 0 : firing.times_us[i] * 1e-6;
    const double offset =
        firing.azimuth_offsets_deg.empty() ? 0 : firing.azimuth_offsets_deg[i] * geometry::kDegree;
    const double azimuth = offset + turn_rate_ * after_s;
    const double elevation = has_mirror_ ? 0 : profile.elevations_deg[i] * geometry::kDegree;
    beams_.push_back(
        {after_s, std::cos(elevation), std::sin(elevation), std::cos(azimuth), std::sin(azimuth)});
  }
}

std::size_t LidarSimulator::sweeps() const {
  return static_cast<std::size_t>(motion_.duration_s() / profile_.sweep_s);
}

double LidarSimulator::begin_s(std::size_t i) const {
  return static_cast<double>(i) * profile_.sweep_s;
}

double LidarSimulator::stamp_s(std::size_t i) const {
  return begin_s(i) + profile_.stamp_fraction * profile_.sweep_s;
}

/// The state of the sensor is known exactly at the firing's start; a beam fires at most 0.1 ms
/// later, where the expansion to second order is exact to rounding.
void LidarSimulator::aim(double seconds, double sweep_begin_s, std::size_t column,
                         Block& block) const {
  const MotionState sensor = motion_.state(seconds).at(T_body_lidar_);
  // A mirror's turns do not begin anew with a sweep.
  const double turned_s = has_mirror_ ? seconds : seconds - sweep_begin_s;
  const double head = profile_.seam_azimuth_deg * geometry::kDegree + turn_rate_ * turned_s;
  const double c = std::cos(head);
  const double s = std::sin(head);
  for (std::size_t beam = 0; beam < beams_.size(); ++beam) {
    const Beam& b = beams_[beam];
    const double dt = b.after_s;
    const Vector3d direction_lidar =
        has_mirror_
            ? by_mirror(beam, seconds + dt)
            : Vector3d(b.cos_elevation * (c * b.cos_azimuth - s * b.sin_azimuth),
                       b.cos_elevation * (s * b.cos_azimuth + c * b.sin_azimuth), b.sin_elevation);
    const Vector3d turn =
        dt * (sensor.angular_rate_body + 0.5 * dt * sensor.angular_acceleration_body);
    const Vector3d turned =
        direction_lidar + turn.cross(direction_lidar + 0.5 * turn.cross(direction_lidar));
    const std::size_t i = beam * kColumns + column;
    block.directions_lidar[i] = direction_lidar;
    block.rays[i].direction = sensor.T_map_body.rotation * turned;
    block.rays[i].origin = sensor.T_map_body.translation +
                           dt * (sensor.velocity_map + 0.5 * dt * sensor.acceleration_map);
    block.seconds[i] = seconds + dt;
  }
}

Vector3d LidarSimulator::by_mirror(std::size_t beam, double seconds) const {
  const sensors::LidarFiring& firing = profile_.firing;
  const sensors::NoddingMirror& mirror = firing.mirror;
  const double at = profile_.seam_azimuth_deg * geometry::kDegree + turn_rate_ * seconds;
  const double nod = std::cos(2 * std::numbers::pi * mirror.nods_hz * seconds);
  const double middle_deg = 0.5 * (mirror.highest_deg + mirror.lowest_deg) +
                            0.5 * (mirror.highest_deg - mirror.lowest_deg) * nod;
  const double tilt_deg =
      mirror.tilts_deg[beam] * std::cos(at - mirror.tilt_azimuth_deg * geometry::kDegree);
  const double elevation = (middle_deg + tilt_deg) * geometry::kDegree;
  const double offset =
      firing.azimuth_offsets_deg.empty() ? 0 : firing.azimuth_offsets_deg[beam] * geometry::kDegree;
  return {std::cos(elevation) * std::cos(at + offset), std::cos(elevation) * std::sin(at + offset),
          std::sin(elevation)};
}

void LidarSimulator::keep(const Block& block, std::size_t column, std::uint64_t firing,
                          double stamp_s, sensors::LidarScan& scan) const {
  const sensors::LidarNoise& noise = profile_.noise;
  for (std::size_t beam = 0; beam < beams_.size(); ++beam) {
    const std::size_t i = beam * kColumns + column;
    const SurfaceHit& hit = block.hits[i];
    if (!hit.is_hit()) continue;
    const CounterNoise::Draw draw = noise_.at(firing, static_cast<std::uint32_t>(beam));
    // The received power falls with the square of the distance.
    const double bright = brightness(hit.material, hit.cosine);
    const double reach = noise.reach_at_10_percent_m * std::sqrt(bright / 0.1);
    if (draw.uniform_1 < noise.dropout_share || hit.distance_m > reach) continue;
    double range = hit.distance_m + noise.range_m * draw.gaussian_1;
    if (noise.resolution_m > 0) range = noise.resolution_m * std::round(range / noise.resolution_m);
    if (range < profile_.min_range_m || range > profile_.max_range_m) continue;
    const Eigen::Vector3f p = (range * block.directions_lidar[i]).cast<float>();
    const double intensity =
        std::clamp(bright * (1 + noise.intensity_share * draw.gaussian_2), 0.0, 1.0);
    scan.x.push_back(p.x());
    scan.y.push_back(p.y());
    scan.z.push_back(p.z());
    scan.intensity.push_back(static_cast<float>(profile_.intensity_full_scale * intensity));
    scan.ring.push_back(static_cast<std::uint16_t>(beam));
    scan.time.push_back(static_cast<float>(block.seconds[i] - stamp_s));
  }
}

sensors::LidarScan LidarSimulator::scan(std::size_t i) const {
  sensors::LidarScan scan;
  scan.stamp = geometry::Stamp::from_seconds(stamp_s(i));
  // The laser fires on and on; a sweep holds the firings that begin in it.
  const auto firing_at = [&](double seconds) {
    return static_cast<std::uint64_t>(std::ceil(seconds / period_s_ - 1e-6));
  };
  const std::uint64_t end = firing_at(begin_s(i + 1));
  std::uint64_t first = firing_at(begin_s(i));
  scan.reserve((end - first) * beams_.size());
  Block block(beams_.size());
  for (; first < end; first += kColumns) {
    for (std::size_t column = 0; column < kColumns; ++column) {
      // The last block casts its last firing several times and keeps one.
      const std::uint64_t firing = std::min(first + column, end - 1);
      aim(static_cast<double>(firing) * period_s_, begin_s(i), column, block);
    }
    surroundings_.cast(block.rays, block.seconds, profile_.max_range_m, block.hits);
    const std::size_t columns = std::min<std::uint64_t>(kColumns, end - first);
    for (std::size_t column = 0; column < columns; ++column) {
      keep(block, column, first + column, stamp_s(i), scan);
    }
  }
  return scan;
}

}  // namespace traverse::simulation
