#pragma once

#include <memory>

#include "traverse/inertial/residuals.hpp"

namespace traverse::inertial {

struct InertialModel {
  static constexpr int kSize = 9;
  std::shared_ptr<const Preintegration> imu;
  Eigen::Vector3d gravity_map;
  Residual<9> operator()(const NavState& i, const NavState& j, Jacobian<9>* Ji,
                         Jacobian<9>* Jj) const {
    return inertial_residual(*imu, gravity_map, i, j, Ji, Jj);
  }
};

struct GyroBiasWalkModel {
  static constexpr int kSize = 3;
  Residual<3> operator()(const NavState& i, const NavState& j, Jacobian<3>* Ji,
                         Jacobian<3>* Jj) const {
    return gyro_bias_walk_residual(i, j, Ji, Jj);
  }
};

struct AccelerometerBiasWalkModel {
  static constexpr int kSize = 3;
  Residual<3> operator()(const NavState& i, const NavState& j, Jacobian<3>* Ji,
                         Jacobian<3>* Jj) const {
    return accelerometer_bias_walk_residual(i, j, Ji, Jj);
  }
};

struct WheelTurnWalkModel {
  static constexpr int kSize = 2;
  Residual<2> operator()(const NavState& i, const NavState& j, Jacobian<2>* Ji,
                         Jacobian<2>* Jj) const {
    return wheel_turn_walk_residual(i, j, Ji, Jj);
  }
};

struct GnssLatencyWalkModel {
  static constexpr int kSize = 1;
  Residual<1> operator()(const NavState& i, const NavState& j, Jacobian<1>* Ji,
                         Jacobian<1>* Jj) const {
    return gnss_latency_walk_residual(i, j, Ji, Jj);
  }
};

struct GnssBiasWalkModel {
  static constexpr int kSize = 3;
  double decay;
  Residual<3> operator()(const NavState& i, const NavState& j, Jacobian<3>* Ji,
                         Jacobian<3>* Jj) const {
    return gnss_bias_walk_residual(decay, i, j, Ji, Jj);
  }
};

struct WheelScaleWalkModel {
  static constexpr int kSize = 1;
  Residual<1> operator()(const NavState& i, const NavState& j, Jacobian<1>* Ji,
                         Jacobian<1>* Jj) const {
    return wheel_scale_walk_residual(i, j, Ji, Jj);
  }
};

}  // namespace traverse::inertial
