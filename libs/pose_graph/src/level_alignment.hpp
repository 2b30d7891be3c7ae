#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "traverse/geometry/pose3.hpp"

namespace traverse::pose_graph {

/// The T_enu_map that brings antennas onto their fixes with up_map upwards: where a graph starts
/// from when it becomes georeferenced. On a straight way positions alone leave the roll about it
/// open; so every pair has a second one above it, as high as the fixes are spread.
/// \param spread the least standard deviation that both sets must have along their longest axis [m]
/// \returns nothing if they do not
std::optional<geometry::Pose3> level_alignment(std::span<const Eigen::Vector3d> antennas_map,
                                               std::span<const Eigen::Vector3d> antennas_enu,
                                               const Eigen::Vector3d& up_map, double spread);

}  // namespace traverse::pose_graph
