#include "residuals/wheel_velocity.hpp"

#include "traverse/geometry/so3.hpp"

#include "residuals/factor_view.hpp"

namespace traverse::inertial {

Residual<WheelVelocityResidual::kSize> WheelVelocityResidual::operator()(
    const NavState& x, Jacobian<kSize>* dr_dx) const {
  const Eigen::Vector3d v_body = x.rotation().transpose() * x.v_map;
  const Eigen::Vector3d v_at_wheels = v_body + (angular_rate - x.gyro_bias).cross(mount.p_body);
  const Eigen::Vector3d told(forward_mps, 0, 0);
  const Eigen::Vector3d turn(0, x.wheel_turn[0], x.wheel_turn[1]);
  const Eigen::Matrix3d R_wheels_body = geometry::exp_so3(turn) * mount.R_wheels_body;
  const Eigen::Vector3d v_wheels = R_wheels_body * v_at_wheels;
  if (dr_dx != nullptr) {
    dr_dx->setZero();
    dr_dx->block<3, 3>(0, NavState::kRotation) = R_wheels_body * geometry::hat(v_body);
    dr_dx->block<3, 3>(0, NavState::kVelocity) = R_wheels_body * x.rotation().transpose();
    dr_dx->block<3, 3>(0, NavState::kGyroBias) = R_wheels_body * geometry::hat(mount.p_body);
    dr_dx->col(NavState::kWheelScale) = -told;
    // Exp(a + d) u = Exp(a) Exp(Jr(a) d) u
    dr_dx->block<3, 2>(0, NavState::kWheelTurn) =
        (-geometry::exp_so3(turn) * geometry::hat(mount.R_wheels_body * v_at_wheels) *
         geometry::right_jacobian(turn))
            .rightCols<2>();
  }
  return v_wheels - x.wheel_scale * told;
}

namespace {

template <typename T>
void wheel_velocity(double forward, const WheelMount& mount, const Eigen::Vector3d& rate,
                    const automatic::State<T>& x, T* residual) {
  using automatic::Vector3;
  const Vector3<T> turning = rate.cast<T>() - x.gyro_bias;
  const Vector3<T> lever = mount.p_body.cast<T>();
  const Vector3<T> at_wheels = x.q.conjugate() * x.v + turning.cross(lever);
  Eigen::Map<Vector3<T>> r(residual);
  const Vector3<T> turn(T(0), x.wheel_turn[0], x.wheel_turn[1]);
  r = automatic::exp_quaternion<T>(turn) * Vector3<T>(mount.R_wheels_body.cast<T>() * at_wheels);
  r[0] -= x.wheel_scale * T(forward);
}

}  // namespace

optimization::FactorKind WheelVelocityResidual::kind() {
  return viewed_kind(kName, "r = Exp(0, m) C (R' v + (w - bg) x l) - s (u, 0, 0)", 1,
                     {{block::kRotation, block::kVelocity, block::kGyroBias, block::kWheelScale,
                       block::kWheelTurn},
                      0,
                      kSize},
                     [](optimization::RandomStates& random) {
                       const double forward = random.uniform(1, 20);
                       WheelMount wheels;
                       wheels.R_wheels_body = geometry::exp_so3(random.vector(0.5));
                       wheels.p_body = random.vector(2);
                       const Eigen::Vector3d rate = random.vector(1);
                       return of_state(WheelVelocityResidual{forward, wheels, rate},
                                       [=](const auto& x, auto* r) {
                                         wheel_velocity(forward, wheels, rate, x, r);
                                       });
                     });
}

}  // namespace traverse::inertial
