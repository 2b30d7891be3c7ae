#include "traverse/loam/scan_features.hpp"

#include <bit>
#include <cstdint>
#include <vector>

#include "traverse/geometry/voxel_set.hpp"
#include "traverse/sensors/sweep_timing.hpp"

namespace traverse::loam {

namespace {

/// 0 .. count - 1, ordered by the reversed bits of the number.
std::vector<std::size_t> bit_reversed_order(std::size_t count) {
  std::vector<std::size_t> order;
  order.reserve(count);
  const auto bits = std::countr_zero(std::bit_ceil(count));
  for (std::size_t i = 0; i < std::bit_ceil(count); ++i) {
    std::size_t reversed = 0;
    for (int b = 0; b < bits; ++b) reversed |= (i >> b & 1U) << (bits - 1 - b);
    if (reversed < count) order.push_back(reversed);
  }
  return order;
}

bool is_edge(lidar::FeatureClass c) {
  return c == lidar::FeatureClass::kSharp || c == lidar::FeatureClass::kLessSharp;
}
bool is_planar(lidar::FeatureClass c) {
  return c == lidar::FeatureClass::kFlat || c == lidar::FeatureClass::kLessFlat;
}

}  // namespace

void bind(config::Binder& b, ThinningOptions& o) {
  using config::Range;
  b.number("edge_voxel_m", o.edge_voxel_m, Range::positive(),
           "voxel size: one edge point per voxel is registered");
  b.number("planar_voxel_m", o.planar_voxel_m, Range::positive(),
           "voxel size: one planar point per voxel is registered");
}

lidar::TimedPoints thinned(const lidar::TimedPoints& points, double voxel_m) {
  lidar::TimedPoints kept;
  geometry::VoxelSet voxels(voxel_m, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!voxels.insert(points.point(i))) continue;
    kept.push_back(points.x[i], points.y[i], points.z[i], points.time[i]);
  }
  return kept;
}

ScanFeatures collect_features(const sensors::LidarScan& scan, const sensors::LidarProfile& profile,
                              const lidar::ScanLines& lines, const Features& features,
                              const ThinningOptions& thinning) {
  const sensors::PointClock clock(scan, profile);
  ScanFeatures result;
  result.stamp = scan.stamp;
  result.points = scan.size();
  result.dropped = lines.dropped;
  result.class_counts = features.counts;
  result.timed = clock.knows();
  for (const std::size_t k : bit_reversed_order(lines.line_count())) {
    for (std::uint32_t i = lines.line_begin[k]; i < lines.line_begin[k + 1]; ++i) {
      const bool edge = is_edge(features.classes[i]);
      if (!edge && !is_planar(features.classes[i])) continue;
      lidar::TimedPoints& points = edge ? result.edges : result.planar;
      points.push_back(lines.x[i], lines.y[i], lines.z[i],
                       clock.knows() ? clock(lines.source[i]) : 0);
    }
  }
  result.thin_edges = thinned(result.edges, thinning.edge_voxel_m);
  result.thin_planar = thinned(result.planar, thinning.planar_voxel_m);
  return result;
}

}  // namespace traverse::loam
