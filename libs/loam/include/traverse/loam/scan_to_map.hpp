#pragma once

#include <vector>

#include <Eigen/Core>

#include "traverse/lidar/frame.hpp"
#include "traverse/loam/association.hpp"
#include "traverse/loam/local_map.hpp"
#include "traverse/loam/registration.hpp"
#include "traverse/loam/scan_features.hpp"

namespace traverse::loam {

struct MapOptions {
  double edge_voxel_m = 0.4;  ///< the edge map keeps one point a cube of this edge
  double planar_voxel_m = 0.8;
  double radius_m = 100;  ///< of the local map
};
void bind(config::Binder& binder, MapOptions& options);

struct ScanToMapOptions {
  MapOptions map;
  AssociationOptions association;
  SolverOptions solver;
  bool deskew = true;
  int threads = 1;
};

/// The matches and the pose of one registration.
struct Registration {
  geometry::Pose3 T_map_lidar;
  lidar::RegistrationHealth health;
  Matches matches;  ///< of the last step
};

/// A local map of edge and planar points, and the registration of scans in it. A value: copies are
/// independent, which the search for the initial speed uses.
class ScanToMap {
 public:
  explicit ScanToMap(const ScanToMapOptions& options);

  /// Associates and solves `steps` times from `guess`, deskewing with `velocity`.
  Registration align(const ScanFeatures& features, const geometry::Pose3& guess_T_map_lidar,
                     const geometry::Twist& velocity, int steps, lidar::StageTimes& ms);

  /// Adds the scan's features at the pose and drops what is far behind.
  void insert(const ScanFeatures& features, const geometry::Pose3& T_map_lidar,
              const geometry::Twist& velocity, lidar::StageTimes& ms);

  /// Of the edge map, then of the planar map; map frame.
  std::vector<Eigen::Vector3d> points() const;

  std::size_t bytes() const { return edge_map_.bytes() + planar_map_.bytes(); }
  std::size_t size() const { return edge_map_.size() + planar_map_.size(); }
  const LocalMap& edge_map() const { return edge_map_; }
  const LocalMap& planar_map() const { return planar_map_; }

 private:
  lidar::TimedPoints at_stamp(const lidar::TimedPoints& points,
                              const geometry::Twist& velocity) const;

  ScanToMapOptions options_;
  LocalMap edge_map_;
  LocalMap planar_map_;
};

}  // namespace traverse::loam
