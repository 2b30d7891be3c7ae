#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

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

/// Fixes of a satellite receiver where they put what the trajectories are of [m, map frame].
struct ShownFixes {
  std::vector<Eigen::Vector3d> taken;
  std::vector<Eigen::Vector3d> rejected;

  bool empty() const { return taken.empty() && rejected.empty(); }
};

/// A square of the map, shown larger in a corner that carries little.
struct MapDetail {
  Eigen::Vector3d centre_map = Eigen::Vector3d::Zero();  ///< m
  double width_m = 5;
};

/// What is drawn beside trajectories.
struct BesideTrajectories {
  std::optional<Eigen::Vector3d> north_map;
  ShownFixes fixes;  ///< points below the lines; those rejected are crosses
  std::optional<MapDetail> detail;
};

/// Trajectories from above in the map frame, x to the right and y up, equal scale; each with its
/// start, its end, a mark at each tenth of its path and arrows between. `reference` may be null; it
/// is drawn dashed. Estimates are drawn as they are: align them before. An arrow points to north,
/// given in the map frame, if it is known.
Drawing trajectory_from_above(std::span<const NamedTrajectory> estimates,
                              const geometry::Trajectory* reference, const Caption& caption,
                              const Style& style, const BesideTrajectories& beside = {});

}  // namespace traverse::render
