#include "residuals/inertial.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "traverse/geometry/so3.hpp"
#include "traverse/inertial/factor_kinds.hpp"

#include "residuals/factor_view.hpp"

namespace traverse::inertial {

using geometry::hat;
using geometry::left_jacobian_inverse;
using geometry::log_so3;
using geometry::right_jacobian;
using geometry::right_jacobian_inverse;

Residual<9> InertialResidual::operator()(const NavState& i, const NavState& j, Jacobian<9>* dr_di,
                                         Jacobian<9>* dr_dj) const {
  using S = NavState;
  const double T = imu->seconds();
  const Preintegration::Increments measured = imu->at(i.gyro_bias, i.accelerometer_bias);
  const Eigen::Matrix3d Ri_t = i.rotation().transpose();
  const Eigen::Matrix3d Rj = j.rotation();
  const Eigen::Vector3d dv = Ri_t * (j.v_map - i.v_map - gravity_map * T);
  const Eigen::Vector3d dp = Ri_t * (j.p_map - i.p_map - i.v_map * T - 0.5 * T * T * gravity_map);

  Residual<9> r;
  const Eigen::Vector3d r_R = log_so3(measured.rotation.transpose() * Ri_t * Rj);
  r.segment<3>(0) = r_R;
  r.segment<3>(3) = dv - measured.velocity;
  r.segment<3>(6) = dp - measured.position;
  if (dr_di == nullptr && dr_dj == nullptr) return r;

  const Eigen::Matrix3d Jr_inverse = right_jacobian_inverse(r_R);
  if (dr_di != nullptr) {
    const Preintegration::BiasJacobians& d = imu->bias_jacobians();
    const Eigen::Vector3d shift = d.rotation_gyro * (i.gyro_bias - imu->gyro_bias());
    Jacobian<9>& J = *dr_di;
    J.setZero();
    J.block<3, 3>(0, S::kRotation) = -Jr_inverse * Rj.transpose() * Ri_t.transpose();  // 4.42
    // 4.45, where Jr^-1(r) Exp(r)' = Jl^-1(r).
    J.block<3, 3>(0, S::kGyroBias) =
        -left_jacobian_inverse(r_R) * right_jacobian(shift) * d.rotation_gyro;
    J.block<3, 3>(3, S::kRotation) = hat(dv);  // 4.47
    J.block<3, 3>(3, S::kVelocity) = -Ri_t;    // 4.46
    J.block<3, 3>(3, S::kGyroBias) = -d.velocity_gyro;
    J.block<3, 3>(3, S::kAccelerometerBias) = -d.velocity_accelerometer;
    J.block<3, 3>(6, S::kRotation) = hat(dp);  // 4.48
    J.block<3, 3>(6, S::kPosition) = -Ri_t;
    J.block<3, 3>(6, S::kVelocity) = -T * Ri_t;
    J.block<3, 3>(6, S::kGyroBias) = -d.position_gyro;
    J.block<3, 3>(6, S::kAccelerometerBias) = -d.position_accelerometer;
  }
  if (dr_dj != nullptr) {
    Jacobian<9>& J = *dr_dj;
    J.setZero();
    J.block<3, 3>(0, S::kRotation) = Jr_inverse;  // 4.43
    J.block<3, 3>(3, S::kVelocity) = Ri_t;        // 4.46
    J.block<3, 3>(6, S::kPosition) = Ri_t;
  }
  return r;
}

namespace {

template <typename T>
void inertial(const Preintegration& imu, const Eigen::Vector3d& gravity,
              const automatic::State<T>& i, const automatic::State<T>& j, T* residual) {
  using automatic::Quaternion;
  using automatic::Vector3;
  const auto& d = imu.bias_jacobians();
  const T seconds(imu.seconds());
  const Vector3<T> d_gyro = i.gyro_bias - imu.gyro_bias().cast<T>();
  const Vector3<T> d_accelerometer = i.accelerometer_bias - imu.accelerometer_bias().cast<T>();
  const Quaternion<T> q_measured =
      Eigen::Quaterniond(imu.increments().rotation).cast<T>() *
      automatic::exp_quaternion<T>(Vector3<T>(d.rotation_gyro.cast<T>() * d_gyro));
  const Vector3<T> v_measured = imu.increments().velocity.cast<T>() +
                                d.velocity_gyro.cast<T>() * d_gyro +
                                d.velocity_accelerometer.cast<T>() * d_accelerometer;
  const Vector3<T> p_measured = imu.increments().position.cast<T>() +
                                d.position_gyro.cast<T>() * d_gyro +
                                d.position_accelerometer.cast<T>() * d_accelerometer;
  const Vector3<T> g = gravity.cast<T>();
  Eigen::Map<Eigen::Matrix<T, 9, 1>> r(residual);
  r.template segment<3>(0) =
      automatic::log_quaternion<T>(q_measured.conjugate() * i.q.conjugate() * j.q);
  r.template segment<3>(3) = i.q.conjugate() * Vector3<T>(j.v - i.v - g * seconds) - v_measured;
  r.template segment<3>(6) =
      i.q.conjugate() * Vector3<T>(j.p - i.p - i.v * seconds - g * (seconds * seconds / T(2))) -
      p_measured;
}

WholeFactor whole_factor(std::shared_ptr<const Preintegration> imu,
                         const Eigen::Vector3d& gravity_map) {
  return of_link(InertialResidual{imu, gravity_map},
                 [imu, gravity_map](const auto& i, const auto& j, auto* r) {
                   inertial(*imu, gravity_map, i, j, r);
                 });
}

WholeFactor inertial_sample(optimization::RandomStates& random) {
  auto imu = std::make_shared<Preintegration>(ImuNoise{}, random.vector(0.02), random.vector(0.1));
  const Eigen::Vector3d rate = random.vector(1);
  const Eigen::Vector3d force = Eigen::Vector3d(0, 0, 9.8) + random.vector(3);
  for (int k = 0; k < 40; ++k) imu->add(rate + random.vector(0.3), force + random.vector(1), 0.01);
  return whole_factor(std::move(imu), {0, 0, -9.81});
}

/// Three rows of the residual and the blocks that they depend on.
struct Rows3 {
  const char* name;
  const char* formula;
  FactorView view;
};
std::vector<Rows3> rows_of_inertial() {
  using namespace block;
  return {
      {InertialResidual::kRotationName,
       "r = Log(dR(bg)' Ri' Rj)",
       {{kRotation, kGyroBias, of_j(kRotation)}, 0, 3}},
      {InertialResidual::kVelocityName,
       "r = Ri' (vj - vi - g T) - dv(bg, ba)",
       {{kRotation, kVelocity, kGyroBias, kAccelerometerBias, of_j(kVelocity)}, 3, 3}},
      {InertialResidual::kPositionName,
       "r = Ri' (pj - pi - vi T - g T^2 / 2) - dp(bg, ba)",
       {{kRotation, kPosition, kVelocity, kGyroBias, kAccelerometerBias, of_j(kPosition)}, 6, 3}}};
}

}  // namespace

std::vector<optimization::FactorKind> InertialResidual::kinds() {
  std::vector<optimization::FactorKind> kinds;
  for (const Rows3& rows : rows_of_inertial()) {
    kinds.push_back(viewed_kind(rows.name, rows.formula, 2, rows.view, inertial_sample));
  }
  return kinds;
}

std::vector<optimization::FactorKind> inertial_kinds_between(const NavState& i, const NavState& j,
                                                             const Eigen::Vector3d& gravity_map) {
  constexpr double kStep_s = 0.01;
  const double seconds = geometry::seconds_between(i.stamp, j.stamp);
  if (!(seconds > 0)) throw std::invalid_argument("the second state must be the later one");
  const Eigen::Matrix3d Ri = i.rotation();
  const Eigen::Vector3d rate =
      geometry::log_so3(Ri.transpose() * j.rotation()) / seconds + i.gyro_bias;
  const Eigen::Vector3d acceleration_map = (j.v_map - i.v_map) / seconds - gravity_map;
  const int steps = std::max(2, static_cast<int>(std::lround(seconds / kStep_s)));
  auto imu = std::make_shared<Preintegration>(ImuNoise{}, i.gyro_bias, i.accelerometer_bias);
  for (int k = 0; k < steps; ++k) {
    const Eigen::Vector3d turned = (k + 0.5) / steps * seconds * (rate - i.gyro_bias);
    const Eigen::Vector3d force =
        (Ri * geometry::exp_so3(turned)).transpose() * acceleration_map + i.accelerometer_bias;
    imu->add(rate, force, seconds / steps);
  }
  const WholeFactor whole = whole_factor(std::move(imu), gravity_map);
  std::vector<optimization::FactorKind> kinds;
  for (const Rows3& rows : rows_of_inertial()) {
    kinds.push_back(viewed_kind_at(rows.name, rows.formula, {i, j}, rows.view, whole));
  }
  return kinds;
}

}  // namespace traverse::inertial
