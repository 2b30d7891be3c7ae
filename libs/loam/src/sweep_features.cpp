#include "traverse/loam/sweep_features.hpp"

#include "traverse/loam/scan_features.hpp"
#include "traverse/sensors/sweep_timing.hpp"

namespace traverse::loam {

namespace {

void append(LinedPoints& to, const lidar::TimedPoints& points, std::size_t line) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    to.points.push_back(points.x[i], points.y[i], points.z[i], points.time[i]);
    to.line.push_back(static_cast<std::uint16_t>(line));
  }
}

}  // namespace

SweepFeatures collect_sweep(const sensors::LidarScan& scan, const sensors::LidarProfile& profile,
                            const lidar::ScanLines& lines, const Features& features,
                            double planar_voxel_m) {
  const sensors::PointClock clock(scan, profile);
  SweepFeatures sweep;
  lidar::TimedPoints edges;
  lidar::TimedPoints planar;
  for (std::size_t k = 0; k < lines.line_count(); ++k) {
    edges.clear();
    planar.clear();
    for (std::uint32_t i = lines.line_begin[k]; i < lines.line_begin[k + 1]; ++i) {
      const lidar::FeatureClass c = features.classes[i];
      if (c == lidar::FeatureClass::kNone) continue;
      const float time = clock.knows() ? clock(lines.source[i]) : 0;
      const auto add_to = [&](lidar::TimedPoints& points) {
        points.push_back(lines.x[i], lines.y[i], lines.z[i], time);
      };
      if (c == lidar::FeatureClass::kSharp) add_to(sweep.sharp);
      if (c == lidar::FeatureClass::kFlat) add_to(sweep.flat);
      add_to(c == lidar::FeatureClass::kSharp || c == lidar::FeatureClass::kLessSharp ? edges
                                                                                      : planar);
    }
    append(sweep.edges, edges, k);
    append(sweep.planar, thinned(planar, planar_voxel_m), k);
  }
  return sweep;
}

}  // namespace traverse::loam
