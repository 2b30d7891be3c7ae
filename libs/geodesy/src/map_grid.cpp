#include "traverse/geodesy/map_grid.hpp"

#include <cmath>

namespace traverse::geodesy {

namespace {

constexpr double kCube_m = 16;

}  // namespace

MapGrid::MapGrid(const Geodetic& origin) : plane_(origin) {
  const Utm utm = to_utm(origin);
  zone_ = utm.zone;
  is_north_ = utm.is_north;
}

int MapGrid::epsg() const {
  if (zone_ == 0) return is_north_ ? 5041 : 5042;
  return (is_north_ ? 32600 : 32700) + zone_;
}

Eigen::Vector3d MapGrid::project(const Eigen::Vector3d& enu) const {
  constexpr double kFalseNorthing_m = 1e7;  // of the southern hemisphere
  const Utm utm = to_utm(plane_.to_geodetic(enu), zone_);
  // The hemisphere is the origin's: a map on the equator has one grid, not two.
  double northing = utm.northing_m;
  if (zone_ != 0 && utm.is_north != is_north_) {
    northing += is_north_ ? -kFalseNorthing_m : kFalseNorthing_m;
  }
  return {utm.easting_m, northing, utm.altitude_m};
}

MapGrid::Cube MapGrid::cube_at(const std::array<std::int32_t, 3>& index) const {
  Cube cube;
  cube.centre_enu = kCube_m * (Eigen::Vector3d(index[0], index[1], index[2]).array() + 0.5);
  cube.centre_grid.setZero();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d half = 0.5 * kCube_m * Eigen::Vector3d::Unit(axis);
    const Eigen::Vector3d ahead = project(cube.centre_enu + half);
    const Eigen::Vector3d behind = project(cube.centre_enu - half);
    cube.by_enu.col(axis) = (ahead - behind) / kCube_m;
    cube.centre_grid += (ahead + behind) / 6;  // the faces' mean halves the error at the corners
  }
  return cube;
}

Eigen::Vector3d MapGrid::to_grid(const Eigen::Vector3d& enu) {
  constexpr std::int32_t kMost = 1 << 20;  // 16,000 km
  std::array<std::int32_t, 3> index{};
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double cell = std::floor(enu[axis] / kCube_m);
    if (!(std::abs(cell) < kMost)) return project(enu);
    index[static_cast<std::size_t>(axis)] = static_cast<std::int32_t>(cell);
    key = (key << 21) | static_cast<std::uint64_t>(static_cast<std::int32_t>(cell) + kMost);
  }
  if (last_ == nullptr || key != last_key_) {
    auto found = cubes_.find(key);
    if (found == cubes_.end()) found = cubes_.emplace(key, cube_at(index)).first;
    last_ = &found->second;
    last_key_ = key;
  }
  return last_->centre_grid + last_->by_enu * (enu - last_->centre_enu);
}

}  // namespace traverse::geodesy
