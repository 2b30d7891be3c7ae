#include "run/nearest_pose.hpp"

#include <nanoflann.hpp>

#include "traverse/geometry/kd_tree_points.hpp"

namespace traverse::report {

namespace {

using PosePositions = geometry::KdTreePoints<std::vector<Eigen::Vector3f>>;
using PoseTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, PosePositions>,
                                        PosePositions, 3, std::uint32_t>;

}  // namespace

std::vector<std::uint16_t> nearest_poses(const std::vector<Eigen::Vector3f>& points,
                                         const geometry::Trajectory& trajectory,
                                         std::size_t stride) {
  PosePositions positions;
  for (std::size_t i = 0; i < trajectory.size(); i += stride) {
    positions.points.push_back(trajectory.pose(i).translation.cast<float>());
  }
  const PoseTree tree(3, positions, nanoflann::KDTreeSingleIndexAdaptorParams(10));
  std::vector<std::uint16_t> nearest;
  nearest.reserve(points.size());
  for (const Eigen::Vector3f& p : points) {
    std::uint32_t index = 0;
    float squared_distance = 0;
    tree.knnSearch(p.data(), 1, &index, &squared_distance);
    nearest.push_back(static_cast<std::uint16_t>(index));
  }
  return nearest;
}

}  // namespace traverse::report
