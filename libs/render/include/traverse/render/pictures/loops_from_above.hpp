#pragma once

#include <span>

#include <Eigen/Core>

#include "traverse/geometry/trajectory.hpp"
#include "traverse/render/caption.hpp"
#include "traverse/render/drawing.hpp"
#include "traverse/render/style.hpp"

namespace traverse::render {

/// Two places that were taken for one: where the vehicle was and where it was taken to be again.
struct LoopMark {
  Eigen::Vector3d keyframe_map;  ///< metres, frame of the trajectories
  Eigen::Vector3d candidate_map;
  bool accepted = false;
};

/// The optimised way from above with the loops that hold it, and beside it, if there is one, the
/// way by odometry. An accepted loop is a dot where it was closed; one that was turned away is a
/// thin line between the two places.
Drawing loops_from_above(const geometry::Trajectory& optimised,
                         const geometry::Trajectory* odometry, std::span<const LoopMark> loops,
                         const Caption& caption, const Style& style);

}  // namespace traverse::render
