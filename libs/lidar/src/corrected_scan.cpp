#include "traverse/lidar/corrected_scan.hpp"

#include <utility>

#include "traverse/lidar/deskew.hpp"
#include "traverse/lidar/scan_lines.hpp"
#include "traverse/sensors/sweep_timing.hpp"

namespace traverse::lidar {

namespace {

CorrectedScan deskew_lines(ScanLines lines, const sensors::LidarScan& scan,
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

}  // namespace

CorrectedScan corrected(const sensors::LidarScan& scan, const sensors::LidarProfile& profile,
                        const geometry::Twist& velocity) {
  return deskew_lines(organise(scan, profile), scan, profile, velocity);
}

CorrectedScan corrected_and_classified(const sensors::LidarScan& scan,
                                       const sensors::LidarProfile& profile,
                                       const geometry::Twist& velocity,
                                       const FeatureOptions& options) {
  ScanLines lines = organise(scan, profile);
  std::vector<FeatureClass> classes = extract_features(lines, options).classes;
  CorrectedScan result = deskew_lines(std::move(lines), scan, profile, velocity);
  result.classes = std::move(classes);
  return result;
}

}  // namespace traverse::lidar
