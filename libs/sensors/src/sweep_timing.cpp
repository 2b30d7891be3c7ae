#include "traverse/sensors/sweep_timing.hpp"

#include <cmath>
#include <numbers>

namespace traverse::sensors {

double sweep_fraction(double azimuth, const LidarProfile& profile) {
  const double seam = profile.seam_azimuth_deg * std::numbers::pi / 180;
  const double turned = profile.rotation == Rotation::kClockwise ? seam - azimuth : azimuth - seam;
  const double revolutions = turned / (2 * std::numbers::pi);
  return revolutions - std::floor(revolutions);
}

PointClock::PointClock(const LidarScan& scan, const LidarProfile& profile)
    : scan_(scan),
      profile_(profile),
      knows_(profile.time_source == TimeSource::kAzimuth ||
             (profile.time_source == TimeSource::kData && !scan.time.empty())) {}

float PointClock::operator()(std::size_t i) const {
  if (profile_.time_source == TimeSource::kData) return scan_.time[i];
  const double azimuth = std::atan2(scan_.y[i], scan_.x[i]);  // in float: exact to nanoseconds
  return static_cast<float>((sweep_fraction(azimuth, profile_) - profile_.stamp_fraction) *
                            profile_.sweep_s);
}

double scan_interval(geometry::Stamp earlier, geometry::Stamp later, const LidarProfile& profile) {
  const double stamped = geometry::seconds_between(earlier, later);
  if (profile.time_source != TimeSource::kAzimuth) return stamped;
  const double sweeps = std::round(stamped / profile.sweep_s);
  const bool steady = sweeps >= 1 && std::abs(stamped / profile.sweep_s - sweeps) < 0.25;
  return steady ? sweeps * profile.sweep_s : stamped;
}

std::vector<float> point_times(const LidarScan& scan, const LidarProfile& profile) {
  const PointClock clock(scan, profile);
  std::vector<float> times;
  if (!clock.knows()) return times;
  times.reserve(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) times.push_back(clock(i));
  return times;
}

}  // namespace traverse::sensors
