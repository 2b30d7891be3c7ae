#include "residuals/heading.hpp"

#include <cmath>
#include <numbers>

#include "residuals/factor_view.hpp"

namespace traverse::inertial {

Residual<HeadingResidual::kSize> HeadingResidual::operator()(const NavState& x,
                                                             Jacobian<kSize>* dr_dx) const {
  constexpr double kVertical = 1e-12;  // squared sine of the x axis from the vertical
  const Eigen::Matrix3d R = x.rotation();
  const double c = R(0, 0) * R(0, 0) + R(1, 0) * R(1, 0);
  if (dr_dx != nullptr) dr_dx->setZero();
  if (c < kVertical) return Residual<1>::Zero();
  if (dr_dx != nullptr) {
    (*dr_dx)(0, NavState::kRotation + 1) = -(R(0, 0) * R(1, 2) - R(1, 0) * R(0, 2)) / c;
    (*dr_dx)(0, NavState::kRotation + 2) = (R(0, 0) * R(1, 1) - R(1, 0) * R(0, 1)) / c;
  }
  const double difference = std::atan2(R(1, 0), R(0, 0)) - heading;
  return Residual<1>(std::remainder(difference, 2 * std::numbers::pi));
}

namespace {

template <typename T>
void heading_less(double measured, const automatic::State<T>& x, T* residual) {
  using std::atan2;
  using std::cos;
  using std::sin;
  const T yaw = atan2(x.R(1, 0), x.R(0, 0));
  residual[0] = atan2(sin(yaw - T(measured)), cos(yaw - T(measured)));
}

}  // namespace

optimization::FactorKind HeadingResidual::kind() {
  return viewed_kind(kName, "r = wrap(atan2(R10, R00) - psi)", 1, {{block::kRotation}, 0, kSize},
                     [](optimization::RandomStates& random) {
                       const double measured = random.uniform(-3, 3);
                       return of_state(HeadingResidual{measured}, [=](const auto& x, auto* r) {
                         heading_less(measured, x, r);
                       });
                     });
}

}  // namespace traverse::inertial
