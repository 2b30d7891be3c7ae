#include "traverse/geodesy/local_tangent_plane.hpp"

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/NormalGravity.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <cmath>
#include <stdexcept>

namespace traverse::geodesy {

using GeographicLib::Geocentric;

namespace {

void check(const Geodetic& place) {
  const bool is_finite = std::isfinite(place.latitude_deg) && std::isfinite(place.longitude_deg) &&
                         std::isfinite(place.altitude_m);
  if (!is_finite || std::abs(place.latitude_deg) > 90) {
    throw std::invalid_argument("a place needs a latitude from -90 to 90 deg and finite numbers");
  }
}

}  // namespace

Eigen::Vector3d to_ecef(const Geodetic& place) {
  Eigen::Vector3d p;
  Geocentric::WGS84().Forward(place.latitude_deg, place.longitude_deg, place.altitude_m, p.x(),
                              p.y(), p.z());
  return p;
}

Geodetic from_ecef(const Eigen::Vector3d& ecef) {
  Geodetic place;
  Geocentric::WGS84().Reverse(ecef.x(), ecef.y(), ecef.z(), place.latitude_deg, place.longitude_deg,
                              place.altitude_m);
  return place;
}

LocalTangentPlane::LocalTangentPlane(const Geodetic& origin) : origin_(origin) {
  check(origin);
  origin_ecef_ = to_ecef(origin);
  const double latitude = origin.latitude_deg * M_PI / 180;
  const double longitude = origin.longitude_deg * M_PI / 180;
  const double sp = std::sin(latitude);
  const double cp = std::cos(latitude);
  const double sl = std::sin(longitude);
  const double cl = std::cos(longitude);
  R_enu_ecef_ << -sl, cl, 0,   //
      -sp * cl, -sp * sl, cp,  //
      cp * cl, cp * sl, sp;
  double north = 0;
  double up = 0;
  GeographicLib::NormalGravity::WGS84().Gravity(origin.latitude_deg, origin.altitude_m, north, up);
  gravity_ = std::hypot(north, up);
}

Eigen::Vector3d LocalTangentPlane::ecef_to_enu(const Eigen::Vector3d& ecef) const {
  return R_enu_ecef_ * (ecef - origin_ecef_);
}

Eigen::Vector3d LocalTangentPlane::to_enu(const Geodetic& place) const {
  return ecef_to_enu(to_ecef(place));
}

Geodetic LocalTangentPlane::to_geodetic(const Eigen::Vector3d& enu) const {
  return from_ecef(origin_ecef_ + R_enu_ecef_.transpose() * enu);
}

Utm to_utm(const Geodetic& place, std::optional<int> zone) {
  check(place);
  Utm utm;
  utm.altitude_m = place.altitude_m;
  double scale = 0;
  try {
    GeographicLib::UTMUPS::Forward(place.latitude_deg, place.longitude_deg, utm.zone, utm.is_north,
                                   utm.easting_m, utm.northing_m, utm.convergence_deg, scale,
                                   zone.value_or(GeographicLib::UTMUPS::STANDARD));
  } catch (const GeographicLib::GeographicErr& error) {
    throw std::invalid_argument(error.what());
  }
  return utm;
}

}  // namespace traverse::geodesy
