#include "residuals/zero_velocity.hpp"

#include "residuals/factor_view.hpp"

namespace traverse::inertial {

Residual<ZeroVelocityResidual::kSize> ZeroVelocityResidual::operator()(
    const NavState& x, Jacobian<kSize>* dr_dx) const {
  Residual<6> r;
  r << x.v_map, angular_rate - x.gyro_bias;
  if (dr_dx != nullptr) {
    dr_dx->setZero();
    dr_dx->block<3, 3>(0, NavState::kVelocity).setIdentity();
    dr_dx->block<3, 3>(3, NavState::kGyroBias) = -Eigen::Matrix3d::Identity();
  }
  return r;
}

namespace {

template <typename T>
void zero_velocity(const Eigen::Vector3d& rate, const automatic::State<T>& x, T* residual) {
  Eigen::Map<Eigen::Matrix<T, 6, 1>> r(residual);
  r << x.v, rate.cast<T>() - x.gyro_bias;
}

}  // namespace

optimization::FactorKind ZeroVelocityResidual::kind() {
  return viewed_kind(kName, "r = (v, w - bg)", 1, {{block::kVelocity, block::kGyroBias}, 0, kSize},
                     [](optimization::RandomStates& random) {
                       const Eigen::Vector3d rate = random.vector(1);
                       return of_state(ZeroVelocityResidual{rate},
                                       [=](const auto& x, auto* r) { zero_velocity(rate, x, r); });
                     });
}

}  // namespace traverse::inertial
