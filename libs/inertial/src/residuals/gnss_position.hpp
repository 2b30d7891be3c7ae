#pragma once

#include "traverse/optimization/factor_kind.hpp"

#include "residuals/residual.hpp"

namespace traverse::inertial {

/// A fix of an antenna on a moving body.
struct AntennaFix {
  Eigen::Vector3d p_map;                                       ///< measured [m]
  Eigen::Vector3d lever_body;                                  ///< of the antenna, body frame [m]
  Eigen::Vector3d angular_rate = Eigen::Vector3d::Zero();      ///< as the IMU read it [rad/s]
  Eigen::Vector3d acceleration_map = Eigen::Vector3d::Zero();  ///< as predicted [m/s^2]
};

/// Where the antenna was at the state's latency before it, to second order in time, with the bias
/// of fixes, less where it was measured, map frame [m].
struct GnssPositionResidual {
  static constexpr int kSize = 3;
  static constexpr const char* kName = "GNSS position";
  AntennaFix fix;

  Residual<kSize> operator()(const NavState& x, Jacobian<kSize>* dr_dx = nullptr) const;

  static optimization::FactorKind kind();
};

}  // namespace traverse::inertial
