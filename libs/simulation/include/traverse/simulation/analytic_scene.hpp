#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace traverse::simulation {

/// What a ray meets first.
struct Hit {
  double distance_m = 0;
  Eigen::Vector3d normal;   ///< of the surface, unit, towards the ray's origin
  double reflectivity = 0;  ///< 0 .. 1
};

/// A flat piece: corner + a u + b v for a, b in [0, 1], u and v perpendicular. Map frame, metres.
struct Rectangle {
  Eigen::Vector3d corner;
  Eigen::Vector3d u;
  Eigen::Vector3d v;
  double reflectivity = 0.5;
};

/// The mantle of an upright cylinder (pole, trunk).
struct Pole {
  Eigen::Vector3d base;  ///< centre of the lower end
  double radius_m = 0.1;
  double height_m = 5;
  double reflectivity = 0.5;
};

/// A place made of rectangles and poles whose distances along rays are closed formulas, so that
/// scans of it are exact to rounding.
class AnalyticScene {
 public:
  void add(const Rectangle& rectangle);
  void add(const Pole& pole);
  /// The five visible sides of an upright box standing on its base; `yaw` [rad] about its centre.
  void add_box(const Eigen::Vector3d& base_centre, const Eigen::Vector3d& size, double yaw,
               double reflectivity);

  /// The nearest surface along `direction` (unit) within `max_distance_m`; nothing into the sky.
  std::optional<Hit> first_hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                               double max_distance_m) const;

  const std::vector<Rectangle>& rectangles() const { return rectangles_; }
  const std::vector<Pole>& poles() const { return poles_; }

 private:
  /// A sphere around a surface: most rays miss most surfaces, and this tells at once.
  struct Bound {
    Eigen::Vector3d centre;
    double squared_radius;
  };
  /// The ray certainly misses the sphere.
  static bool passes(const Bound& bound, const Eigen::Vector3d& origin,
                     const Eigen::Vector3d& direction);

  std::vector<Rectangle> rectangles_;
  std::vector<Bound> rectangle_bounds_;
  std::vector<Pole> poles_;
  std::vector<Bound> pole_bounds_;
};

}  // namespace traverse::simulation
