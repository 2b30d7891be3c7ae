#pragma once

#include <span>
#include <vector>

#include "traverse/simulation/place.hpp"
#include "traverse/simulation/ray_caster.hpp"

namespace traverse::simulation {

/// A place that rays can be sent through, with what moves in it where it is at that moment.
class Surroundings {
 public:
  explicit Surroundings(const Place& place);

  /// One hit a ray; `seconds` is when each leaves, all within a millisecond or so.
  void cast(std::span<const Ray> rays, std::span<const double> seconds, double reach_m,
            std::span<SurfaceHit> hits) const;
  SurfaceHit cast(const Ray& ray, double seconds, double reach_m) const;

  /// Share of the sky above 15 degrees that can be seen from `point`, 0 .. 1. Movers hide nothing.
  double open_sky(const Eigen::Vector3d& point) const;

 private:
  void cast_at(const Mover& mover, std::span<const Ray> rays, std::span<const double> seconds,
               double reach_m, std::span<SurfaceHit> hits) const;

  RayCaster still_;
  std::vector<RayCaster> shapes_;
  std::vector<Mover> movers_;
};

}  // namespace traverse::simulation
