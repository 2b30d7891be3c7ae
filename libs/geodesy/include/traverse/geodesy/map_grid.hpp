#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>

#include <Eigen/Core>

#include "traverse/geodesy/local_tangent_plane.hpp"

namespace traverse::geodesy {

/// The UTM grid (UPS near the poles) that a map is written in: places of the tangent plane at an
/// origin in the zone of that origin, also beyond the zone's edge, for millions of points. In cubes
/// of 16 m the projection is taken for affine, which is off by 0.2 mm at 84 degrees of latitude and
/// by less than 0.05 mm up to 72.
class MapGrid {
 public:
  /// \throws std::invalid_argument for a place that is none
  explicit MapGrid(const Geodetic& origin);

  /// Easting, northing and height above the ellipsoid [m] of a place in the tangent plane (east,
  /// north, up). \throws std::invalid_argument for a place that the zone does not reach
  Eigen::Vector3d to_grid(const Eigen::Vector3d& enu);
  /// The same, without cubes.
  Eigen::Vector3d project(const Eigen::Vector3d& enu) const;

  int zone() const { return zone_; }  ///< 0: UPS
  bool is_north() const { return is_north_; }
  /// Of WGS 84 with this grid, as the EPSG numbers it.
  int epsg() const;

 private:
  struct Cube {
    Eigen::Vector3d centre_enu;
    Eigen::Vector3d centre_grid;
    Eigen::Matrix3d by_enu;  ///< derivative of grid coordinates
  };
  Cube cube_at(const std::array<std::int32_t, 3>& index) const;

  LocalTangentPlane plane_;
  int zone_ = 0;
  bool is_north_ = true;
  std::unordered_map<std::uint64_t, Cube> cubes_;
  std::uint64_t last_key_ = 0;
  const Cube* last_ = nullptr;  ///< elements of the map stay where they are
};

}  // namespace traverse::geodesy
