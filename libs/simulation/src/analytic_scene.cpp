#include "traverse/simulation/analytic_scene.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace traverse::simulation {

namespace {

constexpr double kNearest = 1e-6;  // metres: a ray does not meet the surface it starts on

std::optional<double> distance_to(const Rectangle& r, const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& direction) {
  const Eigen::Vector3d normal = r.u.cross(r.v);
  const double slope = normal.dot(direction);
  if (slope == 0) return std::nullopt;
  const double distance = normal.dot(r.corner - origin) / slope;
  if (distance < kNearest) return std::nullopt;
  const Eigen::Vector3d on_plane = origin + distance * direction - r.corner;
  const double a = on_plane.dot(r.u) / r.u.squaredNorm();
  const double b = on_plane.dot(r.v) / r.v.squaredNorm();
  if (a < 0 || a > 1 || b < 0 || b > 1) return std::nullopt;
  return distance;
}

std::optional<double> distance_to(const Pole& pole, const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& direction) {
  const Eigen::Vector2d o = (origin - pole.base).head<2>();
  const Eigen::Vector2d d = direction.head<2>();
  const double a = d.squaredNorm();
  if (a == 0) return std::nullopt;
  const double b = o.dot(d);
  const double discriminant = b * b - a * (o.squaredNorm() - pole.radius_m * pole.radius_m);
  if (discriminant < 0) return std::nullopt;
  const double distance = (-b - std::sqrt(discriminant)) / a;  // the near side
  const double height = origin.z() + distance * direction.z() - pole.base.z();
  if (distance < kNearest || height < 0 || height > pole.height_m) return std::nullopt;
  return distance;
}

Eigen::Vector3d towards(const Eigen::Vector3d& origin_side, const Eigen::Vector3d& normal) {
  return normal.dot(origin_side) > 0 ? normal : -normal;
}

}  // namespace

void AnalyticScene::add(const Rectangle& rectangle) {
  const Eigen::Vector3d half_diagonal = 0.5 * (rectangle.u + rectangle.v);
  rectangles_.push_back(rectangle);
  rectangle_bounds_.push_back({rectangle.corner + half_diagonal, half_diagonal.squaredNorm()});
}

void AnalyticScene::add(const Pole& pole) {
  const double half_height = 0.5 * pole.height_m;
  poles_.push_back(pole);
  pole_bounds_.push_back({pole.base + Eigen::Vector3d(0, 0, half_height),
                          half_height * half_height + pole.radius_m * pole.radius_m});
}

bool AnalyticScene::passes(const Bound& bound, const Eigen::Vector3d& origin,
                           const Eigen::Vector3d& direction) {
  // Plain numbers: this is the inner loop of every simulated ray.
  const double x = bound.centre.x() - origin.x();
  const double y = bound.centre.y() - origin.y();
  const double z = bound.centre.z() - origin.z();
  const double along = x * direction.x() + y * direction.y() + z * direction.z();
  const double squared_distance = x * x + y * y + z * z;
  const bool inside = squared_distance <= bound.squared_radius;
  return !inside && (along < 0 || squared_distance - along * along > bound.squared_radius);
}

void AnalyticScene::add_box(const Eigen::Vector3d& base_centre, const Eigen::Vector3d& size,
                            double yaw, double reflectivity) {
  const Eigen::Matrix3d R = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Vector3d x = R.col(0) * size.x();
  const Eigen::Vector3d y = R.col(1) * size.y();
  const Eigen::Vector3d z(0, 0, size.z());
  const Eigen::Vector3d corner = base_centre - 0.5 * x - 0.5 * y;
  add(Rectangle{corner, x, z, reflectivity});
  add(Rectangle{corner + y, x, z, reflectivity});
  add(Rectangle{corner, y, z, reflectivity});
  add(Rectangle{corner + x, y, z, reflectivity});
  add(Rectangle{corner + z, x, y, reflectivity});
}

std::optional<Hit> AnalyticScene::first_hit(const Eigen::Vector3d& origin,
                                            const Eigen::Vector3d& direction,
                                            double max_distance_m) const {
  std::optional<Hit> nearest;
  double limit = max_distance_m;
  for (std::size_t i = 0; i < rectangles_.size(); ++i) {
    if (passes(rectangle_bounds_[i], origin, direction)) continue;
    const Rectangle& r = rectangles_[i];
    const auto distance = distance_to(r, origin, direction);
    if (!distance || *distance > limit) continue;
    limit = *distance;
    nearest = Hit{limit, towards(-direction, r.u.cross(r.v).normalized()), r.reflectivity};
  }
  for (std::size_t i = 0; i < poles_.size(); ++i) {
    if (passes(pole_bounds_[i], origin, direction)) continue;
    const Pole& pole = poles_[i];
    const auto distance = distance_to(pole, origin, direction);
    if (!distance || *distance > limit) continue;
    limit = *distance;
    Eigen::Vector3d outward = origin + limit * direction - pole.base;
    outward.z() = 0;
    nearest = Hit{limit, outward.normalized(), pole.reflectivity};
  }
  return nearest;
}

}  // namespace traverse::simulation
