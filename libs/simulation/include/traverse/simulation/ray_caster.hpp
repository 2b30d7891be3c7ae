#pragma once

#include <limits>
#include <memory>
#include <span>

#include <Eigen/Core>

#include "traverse/simulation/mesh.hpp"

namespace traverse::simulation {

struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  ///< unit
};

/// What a ray meets first.
struct SurfaceHit {
  double distance_m = std::numeric_limits<double>::infinity();  ///< infinite: nothing
  double cosine = 0;  ///< of the angle between the ray and the surface's normal, 0 .. 1
  Material material = Material::kAsphalt;

  bool is_hit() const { return distance_m < std::numeric_limits<double>::infinity(); }
};

/// Finds what rays meet. Embree (Wald et al., "Embree: a kernel framework for efficient CPU ray
/// tracing", SIGGRAPH 2014) tells which triangle; the distance is then that to the triangle's plane
/// in double precision. Safe to use from several threads; the same answers for any number of them.
class RayCaster {
 public:
  explicit RayCaster(const Mesh& mesh);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;

  /// One hit a ray, each within `reach_m`. Neighbouring rays are best given side by side.
  void cast(std::span<const Ray> rays, double reach_m, std::span<SurfaceHit> hits) const;
  SurfaceHit cast(const Ray& ray, double reach_m) const;

  /// Radius of the smallest ball about the origin that holds the mesh.
  double radius_m() const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace traverse::simulation
