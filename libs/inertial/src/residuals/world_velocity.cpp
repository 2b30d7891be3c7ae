#include "residuals/world_velocity.hpp"

#include "residuals/factor_view.hpp"

namespace traverse::inertial {

Residual<WorldVelocityResidual::kSize> WorldVelocityResidual::operator()(
    const NavState& x, Jacobian<kSize>* dr_dx) const {
  if (dr_dx != nullptr) {
    dr_dx->setZero();
    dr_dx->block<3, 3>(0, NavState::kVelocity).setIdentity();
  }
  return x.v_map - v_map_measured;
}

namespace {

template <typename T>
void world_velocity(const Eigen::Vector3d& measured, const automatic::State<T>& x, T* residual) {
  Eigen::Map<automatic::Vector3<T>> r(residual);
  r = x.v - measured.cast<T>();
}

}  // namespace

optimization::FactorKind WorldVelocityResidual::kind() {
  return viewed_kind(kName, "r = v - vz", 1, {{block::kVelocity}, 0, kSize},
                     [](optimization::RandomStates& random) {
                       const Eigen::Vector3d measured = random.vector(15);
                       return of_state(
                           WorldVelocityResidual{measured},
                           [=](const auto& x, auto* r) { world_velocity(measured, x, r); });
                     });
}

}  // namespace traverse::inertial
