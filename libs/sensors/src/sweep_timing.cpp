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

std::vector<float> point_times(const LidarScan& scan, const LidarProfile& profile) {
  switch (profile.time_source) {
    case TimeSource::kData:
      return scan.time;
    case TimeSource::kNone:
      return {};
    case TimeSource::kAzimuth:
      break;
  }
  std::vector<float> times;
  times.reserve(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const double azimuth = std::atan2(double{scan.y[i]}, double{scan.x[i]});
    times.push_back(static_cast<float>((sweep_fraction(azimuth, profile) - profile.stamp_fraction) *
                                       profile.sweep_s));
  }
  return times;
}

}  // namespace traverse::sensors
