#pragma once

#include "traverse/simulation/mesh.hpp"

#include "random.hpp"

namespace traverse::simulation {

struct HousePlan {
  double width = 12;  ///< along the street, metres
  double depth = 10;
  int floors = 3;
  bool gabled = true;  ///< otherwise a flat roof with a parapet
};

/// A house whose front's middle stands at the origin, the street towards -y: facades with windows
/// set back into the wall, sills, a door, some balconies, a roof.
Mesh make_house(const HousePlan& plan, Random& random);

}  // namespace traverse::simulation
