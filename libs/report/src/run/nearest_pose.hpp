#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "traverse/geometry/trajectory.hpp"

namespace traverse::report {

/// For each point (map frame) the pose that came nearest to it, counted in steps of `stride` poses,
/// which are the only ones looked at: number k is pose k * stride. There must be no more than
/// 65536.
std::vector<std::uint16_t> nearest_poses(const std::vector<Eigen::Vector3f>& points,
                                         const geometry::Trajectory& trajectory,
                                         std::size_t stride);

}  // namespace traverse::report
