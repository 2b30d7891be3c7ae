#include "residuals/prior.hpp"

#include "traverse/geometry/so3.hpp"

#include "residuals/factor_view.hpp"

namespace traverse::inertial {

Residual<PriorResidual::kSize> PriorResidual::operator()(const NavState& x,
                                                         Jacobian<kSize>* dr_dx) const {
  const NavState::Tangent r = x.minus(expected);
  if (dr_dx != nullptr) {
    dr_dx->setIdentity();
    dr_dx->block<3, 3>(NavState::kRotation, NavState::kRotation) =
        geometry::right_jacobian_inverse(r.segment<3>(NavState::kRotation));
  }
  return r;
}

namespace {

template <typename T>
void prior(const NavState& expected, const automatic::State<T>& x, T* residual) {
  Eigen::Map<Eigen::Matrix<T, NavState::kTangent, 1>> r(residual);
  r.template segment<3>(0) =
      automatic::log_quaternion<T>(expected.q_map_body.cast<T>().conjugate() * x.q);
  r.template segment<3>(3) = x.p - expected.p_map.cast<T>();
  r.template segment<3>(6) = x.v - expected.v_map.cast<T>();
  r.template segment<3>(9) = x.gyro_bias - expected.gyro_bias.cast<T>();
  r.template segment<3>(12) = x.accelerometer_bias - expected.accelerometer_bias.cast<T>();
  r[15] = x.wheel_scale - T(expected.wheel_scale);
  r.template segment<2>(16) = x.wheel_turn - expected.wheel_turn.cast<T>();
  r[18] = x.gnss_latency - T(expected.gnss_latency);
  r.template segment<3>(19) = x.gnss_bias - expected.gnss_bias.cast<T>();
}

}  // namespace

optimization::FactorKind PriorResidual::kind() {
  return viewed_kind(kName, "r = (Log(R0' R), x - x0 for each other part)", 1,
                     {{block::kRotation, block::kPosition, block::kVelocity, block::kGyroBias,
                       block::kAccelerometerBias, block::kWheelScale, block::kWheelTurn,
                       block::kGnssLatency, block::kGnssBias},
                      0,
                      kSize},
                     [](optimization::RandomStates& random) {
                       const NavState around = random_nav_state(random);
                       return of_state(PriorResidual{around}, [=](const auto& state, auto* r) {
                         prior(around, state, r);
                       });
                     });
}

}  // namespace traverse::inertial
