#include "site.hpp"

#include <cmath>

namespace traverse::simulation {

namespace {

constexpr double kKerb = 0.12;       ///< metres
constexpr double kBeyondRoute = 55;  ///< metres of road before the start and behind the end
constexpr double kSunk = -0.5;       ///< metres: the ground below roads and pavements

GroundPlan plan_around(const Route& route, double margin) {
  Eigen::Vector2d least = route.point(0);
  Eigen::Vector2d most = least;
  for (double s = 0; s <= route.lap_m(); s += 2) {
    least = least.cwiseMin(route.point(s));
    most = most.cwiseMax(route.point(s));
  }
  const Eigen::Vector2d wide(margin, margin);
  return {least - wide, most + wide};
}

bool is_closed(const Route& route) {
  return (route.point(route.lap_m()) - route.point(0)).norm() < 1;
}

}  // namespace

Site::Site(const PlaceSettings& s, const Route& r, const Terrain& t, std::uint64_t seed,
           double margin_m, std::optional<std::uint64_t> other_drive)
    : settings(s), route(r), terrain(t), random(seed), plan(plan_around(r, margin_m)) {
  if (other_drive) other_day.emplace(*other_drive);
}

Street Site::main_street() const {
  const bool closed = is_closed(route);
  const double beyond = closed ? 0 : kBeyondRoute;
  return street_along(route, -beyond, route.lap_m() + beyond, settings.lane_offset_m, closed);
}

void build_ground(Site& site, Material material, double cell_m, double height) {
  const Eigen::Vector2d size = site.plan.most() - site.plan.least();
  const auto columns = static_cast<long>(size.x() / cell_m);
  const auto rows = static_cast<long>(size.y() / cell_m);
  // Cells of a metre rise from the sunk ground to the level of the pavement beneath it.
  const double cover = site.settings.pavement_m - 1.2;
  const auto corner = [&](long column, long row) -> Eigen::Vector3d {
    const Eigen::Vector2d p = site.plan.least() + cell_m * Eigen::Vector2d(column, row);
    bool is_near_road = false;
    for (const double dx : {-0.85, 0.0, 0.85}) {
      for (const double dy : {-0.85, 0.0, 0.85}) {
        is_near_road = is_near_road || site.plan.is_road(p + cover * Eigen::Vector2d(dx, dy));
      }
    }
    return site.on_ground(p, is_near_road ? kSunk : height);
  };
  std::vector<Eigen::Vector3d> above, below;
  for (long row = 0; row <= rows; ++row) {
    above.clear();
    for (long column = 0; column <= columns; ++column) above.push_back(corner(column, row));
    for (std::size_t i = 0; row > 0 && i + 1 < above.size(); ++i) {
      site.mesh.add_quad(below[i], below[i + 1], above[i + 1], above[i], material);
    }
    below.swap(above);
  }
}

void build_street(Site& site, const Street& street, unsigned number, double half_width) {
  const double outer = half_width + site.settings.pavement_m;
  const auto crossing = [&](const Eigen::Vector2d& p) {
    return site.plan.is_other_road(p, number);
  };
  // A later road ends where an earlier one is already there.
  const auto is_paved = [&](const Eigen::Vector2d& p) { return number > 0 && crossing(p); };
  constexpr int kStrips = 6;
  for (int i = 0; i < kStrips; ++i) {
    const double left = half_width * (1 - 2.0 * i / kStrips);
    const double right = half_width * (1 - 2.0 * (i + 1) / kStrips);
    sweep(site.mesh, street, site.terrain, {left, 0}, {right, 0}, Material::kAsphalt, is_paved);
  }
  for (const double side : {-1.0, 1.0}) {
    sweep(site.mesh, street, site.terrain, {side * half_width, -0.02}, {side * half_width, kKerb},
          Material::kConcrete, crossing);
    sweep(site.mesh, street, site.terrain, {side * half_width, kKerb},
          {side * (half_width + site.settings.pavement_m / 2), kKerb}, Material::kPaving, crossing);
    sweep(site.mesh, street, site.terrain,
          {side * (half_width + site.settings.pavement_m / 2), kKerb}, {side * outer, kKerb},
          Material::kPaving, crossing);
    sweep(site.mesh, street, site.terrain, {side * outer, kKerb}, {side * outer, -kKerb},
          Material::kConcrete, crossing);
  }
}

}  // namespace traverse::simulation
