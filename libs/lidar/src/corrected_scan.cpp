#include "traverse/lidar/corrected_scan.hpp"

#include <utility>

#include "traverse/lidar/deskew.hpp"
#include "traverse/sensors/sweep_timing.hpp"

namespace traverse::lidar {

CorrectedScan corrected(ScanLines lines, const sensors::LidarScan& scan,
                        const sensors::LidarProfile& profile, const geometry::Twist& velocity) {
  const sensors::PointClock clock(scan, profile);
  if (!clock.knows() || velocity.isZero(0)) {
    return {
        std::move(lines.x), std::move(lines.y), std::move(lines.z), std::move(lines.source), {}};
  }
  TimedPoints points{std::move(lines.x), std::move(lines.y), std::move(lines.z), {}};
  points.time.reserve(points.size());
  for (const std::uint32_t i : lines.source) points.time.push_back(clock(i));
  TimedPoints moved = deskewed(points, velocity);
  return {std::move(moved.x), std::move(moved.y), std::move(moved.z), std::move(lines.source), {}};
}

CorrectedScan corrected(const sensors::LidarScan& scan, const sensors::LidarProfile& profile,
                        const geometry::Twist& velocity) {
  return corrected(organise(scan, profile), scan, profile, velocity);
}

}  // namespace traverse::lidar
