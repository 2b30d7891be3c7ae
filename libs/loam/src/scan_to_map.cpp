#include "traverse/loam/scan_to_map.hpp"

#include <vector>

#include "traverse/lidar/deskew.hpp"
#include "traverse/lidar/stopwatch.hpp"

namespace traverse::loam {

namespace {

std::vector<Eigen::Vector3d> in_map(const lidar::TimedPoints& points,
                                    const geometry::Pose3& T_map_lidar) {
  std::vector<Eigen::Vector3d> result;
  result.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) result.push_back(T_map_lidar * points.point(i));
  return result;
}

}  // namespace

void bind(config::Binder& b, MapOptions& o) {
  using config::Range;
  b.number("edge_voxel_m", o.edge_voxel_m, Range::positive(),
           "voxel size: one edge point per voxel is kept");
  b.number("planar_voxel_m", o.planar_voxel_m, Range::positive(),
           "voxel size: one planar point per voxel is kept");
  b.number("radius_m", o.radius_m, Range::positive(), "radius of the local map");
}

ScanToMap::ScanToMap(const ScanToMapOptions& options)
    : options_(options),
      edge_map_(options.map.edge_voxel_m, options.map.radius_m),
      planar_map_(options.map.planar_voxel_m, options.map.radius_m) {}

std::vector<Eigen::Vector3d> ScanToMap::points() const {
  std::vector<Eigen::Vector3d> points;
  points.reserve(size());
  for (const LocalMap* part : {&edge_map_, &planar_map_}) {
    points.insert(points.end(), part->points().begin(), part->points().end());
  }
  return points;
}

lidar::TimedPoints ScanToMap::at_stamp(const lidar::TimedPoints& points,
                                       const geometry::Twist& velocity) const {
  return options_.deskew ? lidar::deskewed(points, velocity) : points;
}

Registration ScanToMap::align(const ScanFeatures& features,
                              const geometry::Pose3& guess_T_map_lidar,
                              const geometry::Twist& velocity, int steps, lidar::StageTimes& ms) {
  lidar::Stopwatch watch;
  const lidar::TimedPoints edges = at_stamp(features.thin_edges, velocity);
  const lidar::TimedPoints planar = at_stamp(features.thin_planar, velocity);
  watch.lap(ms.deskew);
  for (LocalMap* map : {&edge_map_, &planar_map_}) {
    if (!map->has_index()) map->build_index();
  }
  watch.lap(ms.index);

  Registration result;
  result.T_map_lidar = guess_T_map_lidar;
  for (int step = 0; step < steps; ++step) {
    result.matches = associate(edges, planar, edge_map_, planar_map_, result.T_map_lidar,
                               options_.association, options_.threads);
    watch.lap(ms.associate);
    const SolveResult solved = solve_pose(result.matches, result.T_map_lidar, options_.solver);
    watch.lap(ms.solve);
    ++result.health.steps;
    result.health.line_matches = result.matches.lines.size();
    result.health.plane_matches = result.matches.planes.size();
    result.health.iterations += solved.iterations;
    result.health.observability = solved.observability;
    result.health.residual_rms_m = solved.residual_rms_m;
    result.health.inlier_share = solved.inlier_share;
    result.health.registered = solved.usable;
    result.health.end(solved.reason);
    if (!solved.usable) {
      result.T_map_lidar = guess_T_map_lidar;
      break;
    }
    result.T_map_lidar = solved.T_map_lidar;
  }
  return result;
}

void ScanToMap::insert(const ScanFeatures& features, const geometry::Pose3& T_map_lidar,
                       const geometry::Twist& velocity, lidar::StageTimes& ms) {
  lidar::Stopwatch watch;
  const lidar::TimedPoints edges = at_stamp(features.edges, velocity);
  const lidar::TimedPoints planar = at_stamp(features.planar, velocity);
  watch.lap(ms.deskew);
  edge_map_.insert(in_map(edges, T_map_lidar));
  planar_map_.insert(in_map(planar, T_map_lidar));
  edge_map_.follow(T_map_lidar.translation);
  planar_map_.follow(T_map_lidar.translation);
  watch.lap(ms.insert);
}

}  // namespace traverse::loam
