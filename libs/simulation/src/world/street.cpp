#include "street.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace traverse::simulation {

namespace {

constexpr double kEvery = 1.5;  ///< metres between stations

Eigen::Vector3d on_ground(const Terrain& terrain, const Eigen::Vector2d& p, double height) {
  return {p.x(), p.y(), terrain.height(p.x(), p.y()) + height};
}

}  // namespace

Street::Station Street::at(double s) const {
  const auto after =
      std::lower_bound(stations.begin(), stations.end(), s,
                       [](const Station& station, double v) { return station.s < v; });
  if (after == stations.begin()) return stations.front();
  if (after == stations.end()) return stations.back();
  const Station& a = *std::prev(after);
  const double share = (s - a.s) / (after->s - a.s);
  const double turn = std::remainder(after->heading - a.heading, 2 * std::numbers::pi);
  return {a.point + share * (after->point - a.point), a.heading + share * turn, s};
}

Street Street::part(double from, double to, double every) const {
  Street street;
  const auto count = std::max(1.0, std::ceil((to - from) / every));
  for (double i = 0; i <= count; ++i) street.stations.push_back(at(from + (to - from) * i / count));
  return street;
}

Street street_along(const Route& route, double from, double to, double lane_offset, bool closed) {
  Street street;
  street.closed = closed;
  const auto count = static_cast<std::size_t>(std::ceil((to - from) / kEvery));
  for (std::size_t i = 0; i <= count; ++i) {
    const double s = from + (to - from) * static_cast<double>(i) / static_cast<double>(count);
    const Street::Station on_route{route.point(s), route.heading(s), s - from};
    street.stations.push_back({on_route.beside(lane_offset), on_route.heading, s - from});
  }
  return street;
}

Street straight_street(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  Street street;
  const Eigen::Vector2d way = to - from;
  const double heading = std::atan2(way.y(), way.x());
  const auto count = static_cast<std::size_t>(std::ceil(way.norm() / kEvery));
  for (std::size_t i = 0; i <= count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count);
    street.stations.push_back({from + share * way, heading, share * way.norm()});
  }
  return street;
}

void sweep(Mesh& mesh, const Street& street, const Terrain& terrain, Edge from, Edge to,
           Material material, const std::function<bool(const Eigen::Vector2d&)>& is_open) {
  for (std::size_t i = 0; i + 1 < street.stations.size(); ++i) {
    const Street::Station& a = street.stations[i];
    const Street::Station& b = street.stations[i + 1];
    const double middle = 0.5 * (from.lateral + to.lateral);
    if (is_open && is_open(0.5 * (a.beside(middle) + b.beside(middle)))) continue;
    mesh.add_quad(on_ground(terrain, a.beside(from.lateral), from.height),
                  on_ground(terrain, b.beside(from.lateral), from.height),
                  on_ground(terrain, b.beside(to.lateral), to.height),
                  on_ground(terrain, a.beside(to.lateral), to.height), material);
  }
}

}  // namespace traverse::simulation
