#pragma once

#include <span>
#include <string>

#include "traverse/geometry/trajectory.hpp"
#include "traverse/render/caption.hpp"
#include "traverse/render/colour_map.hpp"
#include "traverse/render/drawing.hpp"
#include "traverse/render/style.hpp"

namespace traverse::render {

/// A number for each pose of a trajectory.
struct PoseValues {
  std::span<const double> values;  ///< one a pose; NaN where there is none
  std::string name;                ///< "APE, translation"
  std::string unit;                ///< "m"
  ColourMap map = ColourMap::kViridis;
};

/// A trajectory from above, coloured by a number of each pose, with the place of the largest
/// marked. Poses without a number are grey. `reference` may be null. \throws std::invalid_argument
/// if there is not one value a pose.
Drawing trajectory_coloured(const geometry::Trajectory& estimate, const PoseValues& values,
                            const geometry::Trajectory* reference, const Caption& caption,
                            const Style& style);

}  // namespace traverse::render
