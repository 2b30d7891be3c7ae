#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "traverse/geometry/pose3.hpp"
#include "traverse/lidar/timed_points.hpp"
#include "traverse/loam/local_map.hpp"
#include "traverse/loam/neighbourhood.hpp"
#include "traverse/loam/residuals.hpp"

namespace traverse::loam {

/// A point of the scan and the line of the map that it should lie on.
struct LineMatch {
  std::uint32_t feature = 0;  ///< index of the edge point in the registration set
  Eigen::Vector3d p_lidar;
  Line line;
  double fraction = 1;  ///< share of the sweep's motion that this point has seen (LOAM's s);
                        ///< solve_pose moves it by Exp(s Log R), s t (PointMotion)
};

/// A point of the scan and the plane of the map that it should lie in.
struct PlaneMatch {
  std::uint32_t feature = 0;  ///< index of the planar point in the registration set
  Eigen::Vector3d p_lidar;
  Plane plane;
  double fraction = 1;  ///< share of the sweep's motion that this point has seen (LOAM's s);
                        ///< solve_pose moves it by Exp(s Log R), s t (PointMotion)
};

struct Matches {
  std::vector<LineMatch> lines;
  std::vector<PlaneMatch> planes;

  std::size_t size() const { return lines.size() + planes.size(); }
  std::size_t bytes() const {
    return lines.size() * sizeof(LineMatch) + planes.size() * sizeof(PlaneMatch);
  }
};

struct AssociationOptions {
  int neighbours = 5;          ///< map points that make a line or a plane
  double search_radius_m = 1;  ///< all of them within this distance
  NeighbourhoodOptions neighbourhood;
};
void bind(config::Binder& binder, AssociationOptions& options);

/// For each edge point the line, for each planar point the plane, through its nearest neighbours
/// in the map, under the pose `T_map_lidar`; points whose neighbours do not make one are left out.
/// The result is in the order of the points for any number of `threads`.
/// Source: LOAM (2014) section VI, F-LOAM (2021) section III-C.
Matches associate(const lidar::TimedPoints& edges, const lidar::TimedPoints& planar,
                  const LocalMap& edge_map, const LocalMap& planar_map,
                  const geometry::Pose3& T_map_lidar, const AssociationOptions& options,
                  int threads);

}  // namespace traverse::loam
