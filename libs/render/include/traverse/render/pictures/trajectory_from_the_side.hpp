#pragma once

#include <span>

#include "traverse/render/pictures/trajectory_from_above.hpp"

namespace traverse::render {

/// Heights of trajectories over the distance that each has travelled. How much heights are
/// exaggerated is stated. `reference` may be null.
Drawing trajectory_from_the_side(std::span<const NamedTrajectory> estimates,
                                 const geometry::Trajectory* reference, const Caption& caption,
                                 const Style& style);

}  // namespace traverse::render
