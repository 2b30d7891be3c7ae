#include "traverse/lidar/voxel/used_points.hpp"

#include <numbers>
#include <utility>

#include "traverse/lidar/deskew.hpp"
#include "traverse/lidar/voxel/sweep_rows.hpp"
#include "traverse/sensors/sweep_timing.hpp"
#include "traverse/sensors/vertical_correction.hpp"

namespace traverse::lidar::voxel {

CorrectedScan used_points(const sensors::LidarScan& scan, const sensors::LidarProfile& profile,
                          const geometry::Twist& velocity) {
  const SweepRows rows(scan, profile);
  const sensors::PointClock clock(scan, profile);
  TimedPoints points;
  points.reserve(scan.size());
  std::vector<std::uint32_t> source;
  source.reserve(scan.size());
  for (std::size_t k = 0; k < rows.count(); ++k) {
    const Row row = rows.row(k);
    for (std::size_t i = 0; i < row.size; ++i) {
      const double range = row.range[i];
      if (range < profile.min_range_m || range > profile.max_range_m) continue;
      source.push_back(row.source_of(i));
      points.push_back(row.x[i], row.y[i], row.z[i], clock.knows() ? clock(source.back()) : 0);
    }
  }
  if (profile.vertical_correction_deg != 0) {
    sensors::correct_elevation(points.x.data(), points.y.data(), points.z.data(), points.size(),
                               profile.vertical_correction_deg * std::numbers::pi / 180);
  }
  if (!velocity.isZero(0)) points = deskewed(points, velocity);
  return {std::move(points.x), std::move(points.y), std::move(points.z), std::move(source), {}};
}

std::vector<FeatureClass> classes_of(const CorrectedScan& used, const SweepSample& sample) {
  std::vector<FeatureClass> of_source(sample.points, FeatureClass::kNone);
  const auto mark = [&](std::uint32_t i, FeatureClass c) { of_source[i] = c; };
  for (std::size_t i = 0; i < sample.surface.size(); ++i) {
    if (sample.surface_is_planar[i] != 0) mark(sample.surface.source[i], FeatureClass::kLessFlat);
  }
  for (const std::uint32_t i : sample.planar.source) mark(i, FeatureClass::kFlat);
  for (const std::uint32_t i : sample.edges.source) mark(i, FeatureClass::kSharp);
  std::vector<FeatureClass> classes;
  classes.reserve(used.source.size());
  for (const std::uint32_t i : used.source) classes.push_back(of_source[i]);
  return classes;
}

}  // namespace traverse::lidar::voxel
