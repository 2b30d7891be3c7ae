#pragma once

#include <cstdint>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/simulation/jet.hpp"

namespace traverse::simulation {

struct TerrainSettings {
  double relief_m = 0;        ///< about how far the ground lies above or below its mean
  double wavelength_m = 300;  ///< of its hills
};
void bind(config::Binder& binder, TerrainSettings& settings);

/// Gentle ground: a sum of plane waves, so that height and slope are closed formulas.
class Terrain {
 public:
  Terrain(const TerrainSettings& settings, std::uint64_t seed);

  /// Height over the x-y plane of the map, metres.
  double height(double x, double y) const;

  /// Height and its slopes along x and y at a point that moves.
  struct Surface {
    Jet height, slope_x, slope_y;
  };
  Surface surface(const Jet& x, const Jet& y) const;

 private:
  struct Wave {
    double amplitude, kx, ky, phase;
  };
  std::vector<Wave> waves_;
};

}  // namespace traverse::simulation
