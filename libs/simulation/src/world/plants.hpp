#pragma once

#include "traverse/simulation/mesh.hpp"

#include "random.hpp"

namespace traverse::simulation {

/// A leafy tree about `height` metres high: trunk, branches, leaves as single triangles, so that
/// rays go through the crown as they do. Stands at the origin.
Mesh make_tree(double height, Random& random);
/// A conifer: leaves from near the ground to the tip.
Mesh make_conifer(double height, Random& random);
/// A ball of leaves on the ground.
Mesh make_bush(double radius, Random& random);
/// A trimmed hedge along x, leaves close together.
Mesh make_hedge(double length, double height, Random& random);
/// Blades and stalks over a patch of ground about the origin.
Mesh make_tall_grass(double radius, Random& random);

}  // namespace traverse::simulation
