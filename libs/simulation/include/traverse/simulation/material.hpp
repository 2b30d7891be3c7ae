#pragma once

#include <cstdint>

namespace traverse::simulation {

enum class Material : std::uint8_t {
  kAsphalt,
  kPaving,
  kMarking,
  kGrass,
  kSoil,
  kBrick,
  kPlaster,
  kConcrete,
  kGlass,
  kMetal,
  kPaint,
  kTyre,
  kBark,
  kFoliage,
  kWood,
  kSign,
  kCloth,
};

/// How a surface returns infrared light (about 900 nm).
struct Reflection {
  double diffuse;    ///< share returned when met head on
  double roughness;  ///< share of it that does not fade with the angle of incidence
};

Reflection reflection_of(Material material);

/// What comes back, as a share of what a white surface met head on returns, for the cosine of the
/// angle of incidence: rho ((1 - m) cos + m), a Lambertian surface with a rough part.
double brightness(Material material, double cosine);

}  // namespace traverse::simulation
