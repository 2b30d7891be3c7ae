#pragma once

#include <memory>
#include <vector>

#include "traverse/optimization/factor_kind.hpp"

#include "factors/preintegration.hpp"
#include "residuals/residual.hpp"

namespace traverse::inertial {

/// (rotation, velocity, position) of the motion from i to j less what the IMU measured
/// [rad, m/s, m].
struct InertialResidual {
  static constexpr int kSize = 9;
  static constexpr const char* kRotationName = "inertial rotation";
  static constexpr const char* kVelocityName = "inertial velocity";
  static constexpr const char* kPositionName = "inertial position";
  std::shared_ptr<const Preintegration> imu;
  Eigen::Vector3d gravity_map;

  Residual<9> operator()(const NavState& i, const NavState& j, Jacobian<9>* dr_di = nullptr,
                         Jacobian<9>* dr_dj = nullptr) const;

  /// Row by row, each with the blocks that it depends on.
  static std::vector<optimization::FactorKind> kinds();
};

}  // namespace traverse::inertial
