#include "traverse/lidar/scan_lines.hpp"

#include <cmath>
#include <numbers>

#include "traverse/sensors/rings.hpp"
#include "traverse/sensors/vertical_correction.hpp"

namespace traverse::lidar {

namespace {

constexpr std::uint16_t kDropped = 0xffff;

/// Marks unusable points in `ring` and counts them by reason.
DroppedPoints mark_unusable(const sensors::LidarScan& scan, const sensors::LidarProfile& profile,
                            std::vector<std::uint16_t>& ring) {
  DroppedPoints dropped;
  const auto least = static_cast<float>(profile.min_range_m * profile.min_range_m);
  const auto most = static_cast<float>(profile.max_range_m * profile.max_range_m);
  const std::size_t rings =
      profile.rings > 0 ? static_cast<std::size_t>(profile.rings) : std::size_t{kDropped};
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const float squared_range =
        scan.x[i] * scan.x[i] + scan.y[i] * scan.y[i] + scan.z[i] * scan.z[i];
    if (squared_range >= least && squared_range <= most && ring[i] < rings) continue;
    if (!std::isfinite(squared_range)) {
      ++dropped.not_finite;
    } else if (squared_range == 0) {
      ++dropped.at_origin;
    } else if (ring[i] >= rings) {
      ++dropped.beyond_profile_rings;
    } else {
      ++dropped.out_of_range;
    }
    ring[i] = kDropped;
  }
  return dropped;
}

}  // namespace

ScanLines organise(const sensors::LidarScan& scan, const sensors::LidarProfile& profile) {
  sensors::RingAssignment rings = sensors::assign_rings(scan, profile);
  ScanLines lines;
  lines.dropped = mark_unusable(scan, profile, rings.ring);

  // Counting sort by ring: stable, so each line keeps the storage order.
  lines.line_begin.assign(rings.ring_count + 1, 0);
  for (const std::uint16_t ring : rings.ring) {
    if (ring != kDropped) ++lines.line_begin[ring + 1U];
  }
  for (std::size_t k = 0; k < rings.ring_count; ++k) {
    lines.line_begin[k + 1] += lines.line_begin[k];
  }
  const std::size_t kept = lines.line_begin.back();
  lines.x.resize(kept);
  lines.y.resize(kept);
  lines.z.resize(kept);
  lines.range.resize(kept);
  lines.source.resize(kept);
  std::vector<std::uint32_t> next = lines.line_begin;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (rings.ring[i] == kDropped) continue;
    const std::size_t at = next[rings.ring[i]]++;
    lines.x[at] = scan.x[i];
    lines.y[at] = scan.y[i];
    lines.z[at] = scan.z[i];
    lines.source[at] = static_cast<std::uint32_t>(i);
  }
  for (std::size_t i = 0; i < kept; ++i) {
    lines.range[i] =
        std::sqrt(lines.x[i] * lines.x[i] + lines.y[i] * lines.y[i] + lines.z[i] * lines.z[i]);
  }
  if (profile.vertical_correction_deg != 0) {
    sensors::correct_elevation(lines.x.data(), lines.y.data(), lines.z.data(), kept,
                               profile.vertical_correction_deg * std::numbers::pi / 180);
  }
  return lines;
}

}  // namespace traverse::lidar
