#pragma once

#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include "traverse/geometry/trajectory.hpp"
#include "traverse/render/caption.hpp"
#include "traverse/render/drawing.hpp"
#include "traverse/render/style.hpp"

namespace traverse::render {

/// A trajectory and what it is called in the legend.
struct NamedTrajectory {
  std::string name;
  const geometry::Trajectory* trajectory = nullptr;  ///< T_map_body
};

/// Trajectories from above in the map frame, x to the right and y up, equal scale; each with its
/// start, its end, a mark at each tenth of its path and arrows between. `reference` may be null; it
/// is drawn dashed. Estimates are drawn as they are: align them before. An arrow points to north,
/// given in the map frame, if it is known.
Drawing trajectory_from_above(std::span<const NamedTrajectory> estimates,
                              const geometry::Trajectory* reference, const Caption& caption,
                              const Style& style, const std::optional<Eigen::Vector3d>& north = {});

}  // namespace traverse::render
