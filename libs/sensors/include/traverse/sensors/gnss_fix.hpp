#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "traverse/geometry/stamp.hpp"

namespace traverse::sensors {

/// One satellite position fix, WGS84.
struct GnssFix {
  geometry::Stamp stamp;
  std::string sensor;
  double latitude_deg = 0;
  double longitude_deg = 0;
  /// Above the ellipsoid where the receiver says so; NaN where it gives none (NMEA RMC alone).
  double altitude_m = 0;
  std::optional<double> heading_deg;  ///< clockwise from true north, only when valid
  /// Position covariance in east, north, up [m^2], where the recording has one.
  std::optional<Eigen::Matrix3d> covariance_enu;
};

}  // namespace traverse::sensors
