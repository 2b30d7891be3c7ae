#include "traverse/simulation/material.hpp"

namespace traverse::simulation {

Reflection reflection_of(Material material) {
  switch (material) {
    case Material::kAsphalt:
      return {0.20, 0.35};
    case Material::kPaving:
      return {0.35, 0.3};
    case Material::kMarking:
      return {0.75, 0.6};
    case Material::kGrass:
      return {0.45, 0.5};
    case Material::kSoil:
      return {0.3, 0.4};
    case Material::kBrick:
      return {0.45, 0.15};
    case Material::kPlaster:
      return {0.65, 0.1};
    case Material::kConcrete:
      return {0.4, 0.15};
    case Material::kGlass:
      return {0.08, 0};
    case Material::kMetal:
      return {0.5, 0.05};
    case Material::kPaint:
      return {0.55, 0.05};
    case Material::kTyre:
      return {0.06, 0.3};
    case Material::kBark:
      return {0.35, 0.3};
    case Material::kFoliage:
      return {0.5, 0.5};
    case Material::kWood:
      return {0.5, 0.2};
    case Material::kSign:
      return {1.0, 0.9};
    case Material::kCloth:
      return {0.4, 0.4};
  }
  return {0.5, 0};
}

double brightness(Material material, double cosine) {
  const Reflection r = reflection_of(material);
  return r.diffuse * ((1 - r.roughness) * cosine + r.roughness);
}

}  // namespace traverse::simulation
