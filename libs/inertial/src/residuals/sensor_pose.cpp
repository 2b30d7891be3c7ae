#include "residuals/sensor_pose.hpp"

#include "traverse/geometry/so3.hpp"

#include "residuals/factor_view.hpp"

namespace traverse::inertial {

Residual<SensorPoseResidual::kSize> SensorPoseResidual::operator()(const NavState& x,
                                                                   Jacobian<kSize>* dr_dx) const {
  const Eigen::Matrix3d R = x.rotation();
  Residual<6> r;
  r << geometry::log_so3(T_map_sensor.rotation.transpose() * R),
      x.p_map + R * p_body - T_map_sensor.translation;
  if (dr_dx != nullptr) {
    dr_dx->setZero();
    dr_dx->block<3, 3>(0, NavState::kRotation) = geometry::right_jacobian_inverse(r.head<3>());
    dr_dx->block<3, 3>(3, NavState::kRotation) = -R * geometry::hat(p_body);
    dr_dx->block<3, 3>(3, NavState::kPosition).setIdentity();
  }
  return r;
}

namespace {

template <typename T>
void sensor_pose(const geometry::Pose3& found, const Eigen::Vector3d& p_body,
                 const automatic::State<T>& x, T* residual) {
  Eigen::Map<Eigen::Matrix<T, 6, 1>> r(residual);
  r.template segment<3>(0) =
      automatic::log_quaternion<T>(found.quaternion().cast<T>().conjugate() * x.q);
  r.template segment<3>(3) = x.p + x.R * p_body.cast<T>() - found.translation.cast<T>();
}

}  // namespace

optimization::FactorKind SensorPoseResidual::kind() {
  return viewed_kind(
      kName, "r = (Log(R0' R), p + R l - t0)", 1, {{block::kRotation, block::kPosition}, 0, kSize},
      [](optimization::RandomStates& random) {
        const NavState around = random_nav_state(random);
        const Eigen::Vector3d arm = random.vector(2);
        const geometry::Pose3 found = around.T_map_body();
        return of_state(SensorPoseResidual{found, arm},
                        [=](const auto& x, auto* r) { sensor_pose(found, arm, x, r); });
      });
}

}  // namespace traverse::inertial
