#include "residuals/gnss_position.hpp"

#include "traverse/geometry/so3.hpp"

#include "residuals/factor_view.hpp"

namespace traverse::inertial {

Residual<GnssPositionResidual::kSize> GnssPositionResidual::operator()(
    const NavState& x, Jacobian<kSize>* dr_dx) const {
  const Eigen::Matrix3d R = x.rotation();
  const Eigen::Vector3d& l = fix.lever_body;
  const double t = x.gnss_latency;
  const Eigen::Vector3d swing = (fix.angular_rate - x.gyro_bias).cross(l);
  const Eigen::Vector3d v_antenna = x.v_map + R * swing;
  if (dr_dx != nullptr) {
    dr_dx->setZero();
    dr_dx->block<3, 3>(0, NavState::kRotation) = -R * geometry::hat(l - t * swing);
    dr_dx->block<3, 3>(0, NavState::kPosition).setIdentity();
    dr_dx->block<3, 3>(0, NavState::kVelocity) = -t * Eigen::Matrix3d::Identity();
    dr_dx->block<3, 3>(0, NavState::kGyroBias) = -t * R * geometry::hat(l);
    dr_dx->block<3, 3>(0, NavState::kGnssBias).setIdentity();
    dr_dx->col(NavState::kGnssLatency) = t * fix.acceleration_map - v_antenna;
  }
  return x.p_map + R * l - t * v_antenna + 0.5 * t * t * fix.acceleration_map + x.gnss_bias -
         fix.p_map;
}

namespace {

template <typename T>
void gnss_position(const AntennaFix& fix, const automatic::State<T>& x, T* residual) {
  using automatic::Vector3;
  const Vector3<T> lever = fix.lever_body.cast<T>();
  const Vector3<T> turning = fix.angular_rate.cast<T>() - x.gyro_bias;
  const Vector3<T> v = x.v + x.q * Vector3<T>(turning.cross(lever));
  const Vector3<T> a = fix.acceleration_map.cast<T>();
  const T t = x.gnss_latency;
  Eigen::Map<Vector3<T>> r(residual);
  r = x.q * lever + x.p - v * t + a * (t * t / T(2)) + x.gnss_bias - fix.p_map.cast<T>();
}

}  // namespace

optimization::FactorKind GnssPositionResidual::kind() {
  return viewed_kind(kName, "r = p + R l - t (v + R ((w - bg) x l)) + a t^2 / 2 + c - z", 1,
                     {{block::kRotation, block::kPosition, block::kVelocity, block::kGyroBias,
                       block::kGnssLatency, block::kGnssBias},
                      0,
                      kSize},
                     [](optimization::RandomStates& random) {
                       const AntennaFix antenna{random.vector(50), random.vector(2),
                                                random.vector(1), random.vector(3)};
                       return of_state(GnssPositionResidual{antenna}, [=](const auto& x, auto* r) {
                         gnss_position(antenna, x, r);
                       });
                     });
}

}  // namespace traverse::inertial
