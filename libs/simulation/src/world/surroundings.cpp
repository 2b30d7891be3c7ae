#include "traverse/simulation/surroundings.hpp"

#include <cmath>

#include "traverse/geometry/angle.hpp"

namespace traverse::simulation {

namespace {

/// Metres that a mover may go while the rays of one call leave.
constexpr double kMovesMeanwhile = 0.5;

/// The ray may come nearer to `centre` than `radius`.
bool may_meet(const Ray& ray, const Eigen::Vector3d& centre, double radius) {
  const Eigen::Vector3d to_centre = centre - ray.origin;
  const double along = std::max(0.0, to_centre.dot(ray.direction));
  return (to_centre - along * ray.direction).squaredNorm() <= radius * radius;
}

}  // namespace

Surroundings::Surroundings(const Place& place) : still_(place.still), movers_(place.movers) {
  for (const Mesh& shape : place.shapes) shapes_.emplace_back(shape);
}

void Surroundings::cast(std::span<const Ray> rays, std::span<const double> seconds, double reach_m,
                        std::span<SurfaceHit> hits) const {
  still_.cast(rays, reach_m, hits);
  for (const Mover& mover : movers_) cast_at(mover, rays, seconds, reach_m, hits);
}

SurfaceHit Surroundings::cast(const Ray& ray, double seconds, double reach_m) const {
  SurfaceHit hit;
  cast(std::span(&ray, 1), std::span(&seconds, 1), reach_m, std::span(&hit, 1));
  return hit;
}

void Surroundings::cast_at(const Mover& mover, std::span<const Ray> rays,
                           std::span<const double> seconds, double reach_m,
                           std::span<SurfaceHit> hits) const {
  if (rays.empty()) return;
  const RayCaster& shape = shapes_[mover.shape];
  const Eigen::Vector3d centre = mover.T_map_mover(seconds.front()).translation;
  const double radius = shape.radius_m() + kMovesMeanwhile;
  if ((centre - rays.front().origin).norm() > reach_m + radius) return;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!may_meet(rays[i], centre, radius)) continue;
    const geometry::Pose3 T_mover_map = mover.T_map_mover(seconds[i]).inverse();
    const Ray ray{T_mover_map * rays[i].origin, T_mover_map.rotation * rays[i].direction};
    const SurfaceHit hit = shape.cast(ray, reach_m);
    if (hit.distance_m < hits[i].distance_m) hits[i] = hit;
  }
}

double Surroundings::open_sky(const Eigen::Vector3d& point) const {
  constexpr double kFar = 300;
  int open = 0;
  int all = 0;
  for (const double elevation : {20.0, 35.0, 50.0, 70.0, 88.0}) {
    for (double azimuth = 0; azimuth < 360; azimuth += 45) {
      const double e = elevation * geometry::kDegree;
      const double a = azimuth * geometry::kDegree;
      const Ray ray{point, {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)}};
      open += still_.cast(ray, kFar).is_hit() ? 0 : 1;
      ++all;
    }
  }
  return static_cast<double>(open) / all;
}

}  // namespace traverse::simulation
