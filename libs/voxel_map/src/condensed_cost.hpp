#pragma once

#include <ceres/sized_cost_function.h>

#include "traverse/voxel_map/scan_objective.hpp"

namespace traverse::voxel_map {

/// The whole scan as one Ceres cost of seven residuals. With the normal equations H, g and the cost
/// c at a pose, and H = L L',
///     r = [L^-1 g; sqrt(2 c - |L^-1 g|^2)],   J = [L'; 0]
/// has r'r = 2 c, J'r = g and J'J = H: value, gradient and Gauss-Newton model are those of the
/// thousands of residuals behind it. Blocks: quaternion [x y z w] on RotationManifold,
/// t_map_lidar [3].
class CondensedCost final : public ceres::SizedCostFunction<7, 4, 3> {
 public:
  CondensedCost(const ScanMatches& matches, const MotionModel& motion,
                const ObjectiveOptions& options, parallel::Workers& workers)
      : matches_(matches), motion_(motion), options_(options), workers_(workers) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

  /// The normal equations at the pose; those of the last pose are remembered, because Ceres asks
  /// for the derivative where it has just asked for the value.
  const NormalEquations& at(const geometry::Pose3& T_map_lidar) const;

 private:
  const ScanMatches& matches_;
  const MotionModel& motion_;
  const ObjectiveOptions& options_;
  parallel::Workers& workers_;
  mutable bool known_ = false;
  mutable geometry::Pose3 last_pose_;
  mutable NormalEquations last_;
};

}  // namespace traverse::voxel_map
