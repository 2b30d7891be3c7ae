#include "residuals/gnss_pose.hpp"

#include "traverse/geometry/so3.hpp"

#include "residuals/factor_view.hpp"

namespace traverse::inertial {

Residual<GnssPoseResidual::kSize> GnssPoseResidual::operator()(const NavState& x,
                                                               Jacobian<kSize>* dr_dx) const {
  Residual<6> r;
  r.head<3>() = geometry::log_so3(T_map_body_measured.rotation.transpose() * x.rotation());
  r.tail<3>() = x.p_map - T_map_body_measured.translation;
  if (dr_dx != nullptr) {
    dr_dx->setZero();
    dr_dx->block<3, 3>(0, NavState::kRotation) = geometry::right_jacobian_inverse(r.head<3>());
    dr_dx->block<3, 3>(3, NavState::kPosition).setIdentity();
  }
  return r;
}

namespace {

template <typename T>
void gnss_pose(const geometry::Pose3& measured, const automatic::State<T>& x, T* residual) {
  Eigen::Map<Eigen::Matrix<T, 6, 1>> r(residual);
  r << automatic::log_quaternion<T>(measured.quaternion().cast<T>().conjugate() * x.q),
      x.p - measured.translation.cast<T>();
}

}  // namespace

optimization::FactorKind GnssPoseResidual::kind() {
  return viewed_kind(kName, "r = (Log(Rz' R), p - pz)", 1,
                     {{block::kRotation, block::kPosition}, 0, kSize},
                     [](optimization::RandomStates& random) {
                       const geometry::Pose3 measured = random_nav_state(random).T_map_body();
                       return of_state(GnssPoseResidual{measured},
                                       [=](const auto& x, auto* r) { gnss_pose(measured, x, r); });
                     });
}

}  // namespace traverse::inertial
