#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

namespace traverse::geodesy {

/// A place on the WGS84 ellipsoid.
struct Geodetic {
  double latitude_deg = 0;
  double longitude_deg = 0;
  double altitude_m = 0;  ///< above the ellipsoid
};

/// The plane that touches the ellipsoid's parallel surface at an origin: x east, y north, z up,
/// metres. Unlike a map projection it has no scale and its north is true north at the origin.
class LocalTangentPlane {
 public:
  /// \throws std::invalid_argument unless the latitude is in [-90, 90] and all is finite.
  explicit LocalTangentPlane(const Geodetic& origin);

  Eigen::Vector3d to_enu(const Geodetic& place) const;
  Geodetic to_geodetic(const Eigen::Vector3d& enu) const;
  /// Of earth-centred, earth-fixed coordinates [m].
  Eigen::Vector3d ecef_to_enu(const Eigen::Vector3d& ecef) const;

  const Geodetic& origin() const { return origin_; }
  const Eigen::Matrix3d& R_enu_ecef() const { return R_enu_ecef_; }
  /// Normal gravity at the origin, positive [m/s^2].
  double gravity() const { return gravity_; }

 private:
  Geodetic origin_;
  Eigen::Vector3d origin_ecef_;
  Eigen::Matrix3d R_enu_ecef_;
  double gravity_ = 0;
};

Eigen::Vector3d to_ecef(const Geodetic& place);
Geodetic from_ecef(const Eigen::Vector3d& ecef);

/// A place on the UTM grid, for output.
struct Utm {
  int zone = 0;  ///< 1 to 60; 0 near the poles, where the grid is UPS
  bool is_north = true;
  double easting_m = 0;
  double northing_m = 0;
  double altitude_m = 0;
  /// From true north to grid north, clockwise: a true heading is grid heading + convergence.
  double convergence_deg = 0;
};

/// \param zone  to stay in when a path crosses a zone's edge; without it the standard one
/// \throws std::invalid_argument for a place that the zone does not reach.
Utm to_utm(const Geodetic& place, std::optional<int> zone = std::nullopt);

}  // namespace traverse::geodesy
