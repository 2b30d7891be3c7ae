#include "traverse/voxel_map/used_points.hpp"

#include <numbers>
#include <utility>

#include "traverse/lidar/deskew.hpp"
#include "traverse/sensors/sweep_timing.hpp"
#include "traverse/sensors/vertical_correction.hpp"
#include "traverse/voxel_map/sweep_rows.hpp"

namespace traverse::voxel_map {

lidar::CorrectedScan used_points(const sensors::LidarScan& scan,
                                 const sensors::LidarProfile& profile,
                                 const geometry::Twist& velocity) {
  const SweepRows rows(scan, profile);
  const sensors::PointClock clock(scan, profile);
  lidar::TimedPoints points;
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
  if (!velocity.isZero(0)) points = lidar::deskewed(points, velocity);
  return {std::move(points.x), std::move(points.y), std::move(points.z), std::move(source), {}};
}

std::vector<lidar::FeatureClass> classes_of(const lidar::CorrectedScan& used,
                                            const SweepSample& sample) {
  std::vector<lidar::FeatureClass> of_source(sample.points, lidar::FeatureClass::kNone);
  const auto mark = [&](std::uint32_t i, lidar::FeatureClass c) { of_source[i] = c; };
  for (std::size_t i = 0; i < sample.surface.size(); ++i) {
    if (sample.surface_is_planar[i] != 0)
      mark(sample.surface.source[i], lidar::FeatureClass::kLessFlat);
  }
  for (const std::uint32_t i : sample.planar.source) mark(i, lidar::FeatureClass::kFlat);
  for (const std::uint32_t i : sample.edges.source) mark(i, lidar::FeatureClass::kSharp);
  std::vector<lidar::FeatureClass> classes;
  classes.reserve(used.source.size());
  for (const std::uint32_t i : used.source) classes.push_back(of_source[i]);
  return classes;
}

}  // namespace traverse::voxel_map
