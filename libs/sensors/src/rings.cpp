#include "traverse/sensors/rings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

namespace traverse::sensors {

namespace {

RingAssignment from_data(const LidarScan& scan) {
  if (scan.ring.empty() && !scan.empty()) {
    throw NoRings("the points carry no ring number; name a profile whose ring_source fits");
  }
  return {scan.ring, 0};
}

/// Points stored ring after ring, each ring counterclockwise from straight ahead: a new ring
/// begins where y goes from negative to non-negative with x positive. Points without a return keep
/// the ring they stand in.
RingAssignment from_storage_order(const LidarScan& scan) {
  RingAssignment result;
  result.ring.reserve(scan.size());
  std::uint16_t ring = 0;
  float previous_y = 0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const bool wrapped = previous_y < 0 && scan.y[i] >= 0 && scan.x[i] > 0;
    if (wrapped && ring < std::numeric_limits<std::uint16_t>::max()) ++ring;
    if (scan.x[i] != 0 || scan.y[i] != 0) previous_y = scan.y[i];
    result.ring.push_back(ring);
  }
  return result;
}

RingAssignment from_elevation(const LidarScan& scan, const LidarProfile& profile) {
  if (profile.elevations_deg.empty()) {
    throw NoRings(fmt::format("profile '{}' has no elevations_deg to find rings by", profile.name));
  }
  struct Beam {
    double elevation_deg;
    std::uint16_t ring;
  };
  std::vector<Beam> beams;
  for (std::size_t i = 0; i < profile.elevations_deg.size(); ++i) {
    beams.push_back({profile.elevations_deg[i], static_cast<std::uint16_t>(i)});
  }
  std::sort(beams.begin(), beams.end(),
            [](const Beam& a, const Beam& b) { return a.elevation_deg < b.elevation_deg; });

  RingAssignment result;
  result.ring.reserve(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const double elevation_deg =
        std::atan2(double{scan.z[i]}, std::hypot(double{scan.x[i]}, double{scan.y[i]})) * 180 /
        std::numbers::pi;
    auto above =
        std::lower_bound(beams.begin(), beams.end(), elevation_deg,
                         [](const Beam& beam, double value) { return beam.elevation_deg < value; });
    if (above == beams.end()) --above;
    const bool below_is_nearer =
        above != beams.begin() && elevation_deg - std::prev(above)->elevation_deg <
                                      std::abs(above->elevation_deg - elevation_deg);
    result.ring.push_back(below_is_nearer ? std::prev(above)->ring : above->ring);
  }
  return result;
}

}  // namespace

RingAssignment assign_rings(const LidarScan& scan, const LidarProfile& profile) {
  RingAssignment result;
  switch (profile.ring_source) {
    case RingSource::kData:
      result = from_data(scan);
      break;
    case RingSource::kStorageOrder:
      result = from_storage_order(scan);
      break;
    case RingSource::kElevation:
      result = from_elevation(scan, profile);
      break;
  }
  for (const std::uint16_t ring : result.ring) {
    result.ring_count = std::max<std::size_t>(result.ring_count, ring + 1U);
  }
  return result;
}

std::vector<std::uint16_t> rings_if_known(const LidarScan& scan, const LidarProfile& profile) {
  try {
    return assign_rings(scan, profile).ring;
  } catch (const NoRings&) {
    return {};
  }
}

}  // namespace traverse::sensors
