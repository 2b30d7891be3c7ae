#include "traverse/simulation/terrain.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace traverse::simulation {

void bind(config::Binder& b, TerrainSettings& s) {
  b.number("relief_m", s.relief_m, config::Range::between(0, 30),
           "amplitude of the ground's height about its mean");
  b.number("wavelength_m", s.wavelength_m, config::Range::between(50, 10000),
           "wavelength of the hills");
}

Terrain::Terrain(const TerrainSettings& settings, std::uint64_t seed) {
  if (settings.relief_m == 0) return;
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  constexpr int kWaves = 4;
  for (int i = 0; i < kWaves; ++i) {
    const double length = settings.wavelength_m * (0.7 + 0.6 * uniform(generator));
    const double direction = std::numbers::pi * (i + uniform(generator)) / kWaves;
    const double k = 2 * std::numbers::pi / length;
    waves_.push_back({settings.relief_m / std::sqrt(0.5 * kWaves), k * std::cos(direction),
                      k * std::sin(direction), 2 * std::numbers::pi * uniform(generator)});
  }
}

double Terrain::height(double x, double y) const {
  double sum = 0;
  for (const Wave& w : waves_) sum += w.amplitude * std::sin(w.kx * x + w.ky * y + w.phase);
  return sum;
}

Terrain::Surface Terrain::surface(const Jet& x, const Jet& y) const {
  Surface result;
  for (const Wave& w : waves_) {
    const Jet angle = w.kx * x + w.ky * y + w.phase;
    const Jet slope = w.amplitude * cos(angle);
    result.height += w.amplitude * sin(angle);
    result.slope_x += w.kx * slope;
    result.slope_y += w.ky * slope;
  }
  return result;
}

}  // namespace traverse::simulation
