#pragma once

#include <vector>

#include "traverse/optimization/factor_kind.hpp"

#include "residuals/residual.hpp"

namespace traverse::inertial {

/// What two states differ by in a part that only walks: r = part of j - decay * part of i. With a
/// decay below one, the share of i that is left in j, a first-order Gauss-Markov process.
template <int kPart, int N>
struct WalkResidual {
  static constexpr int kSize = N;
  double decay = 1;

  Residual<N> operator()(const NavState& i, const NavState& j, Jacobian<N>* dr_di = nullptr,
                         Jacobian<N>* dr_dj = nullptr) const {
    if (dr_di != nullptr) {
      dr_di->setZero();
      dr_di->template block<N, N>(0, kPart) = -decay * Eigen::Matrix<double, N, N>::Identity();
    }
    if (dr_dj != nullptr) {
      dr_dj->setZero();
      dr_dj->template block<N, N>(0, kPart).setIdentity();
    }
    return part_of(j) - decay * part_of(i);
  }

 private:
  static Residual<N> part_of(const NavState& x) {
    if constexpr (kPart == NavState::kGyroBias) return x.gyro_bias;
    if constexpr (kPart == NavState::kAccelerometerBias) return x.accelerometer_bias;
    if constexpr (kPart == NavState::kWheelScale) return Residual<1>(x.wheel_scale);
    if constexpr (kPart == NavState::kWheelTurn) return x.wheel_turn;
    if constexpr (kPart == NavState::kGnssLatency) return Residual<1>(x.gnss_latency);
    if constexpr (kPart == NavState::kGnssBias) return x.gnss_bias;
  }
};

using GyroBiasWalk = WalkResidual<NavState::kGyroBias, 3>;
using AccelerometerBiasWalk = WalkResidual<NavState::kAccelerometerBias, 3>;
using WheelScaleWalk = WalkResidual<NavState::kWheelScale, 1>;
using WheelTurnWalk = WalkResidual<NavState::kWheelTurn, 2>;
using GnssLatencyWalk = WalkResidual<NavState::kGnssLatency, 1>;
using GnssBiasWalk = WalkResidual<NavState::kGnssBias, 3>;

/// The kinds of all walks; every link of the smoother has each of them.
std::vector<optimization::FactorKind> walk_kinds();

}  // namespace traverse::inertial
