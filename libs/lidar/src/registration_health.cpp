#include "traverse/lidar/registration_health.hpp"

#include <algorithm>

namespace traverse::lidar {

namespace {

constexpr double kLeastEigenvalue = 1e-4;  // of a match: below, a direction is not determined
constexpr double kLeastResidual_m = 0.01;  // a perfect fit would mean perfect knowledge

}  // namespace

Matrix6 RegistrationHealth::covariance() const {
  const double residual_m = std::max(residual_rms_m, kLeastResidual_m);
  const auto count = static_cast<double>(std::max<std::size_t>(matches(), 1));
  const Vector6 inverse = observability.eigenvalues.cwiseMax(kLeastEigenvalue).cwiseInverse();
  const Matrix6& V = observability.directions;
  Matrix6 covariance = V * inverse.asDiagonal() * V.transpose();
  covariance *= residual_m * residual_m / count;
  covariance.topRows<3>() /= observability.rotation_scale_m;
  covariance.leftCols<3>() /= observability.rotation_scale_m;
  return covariance;
}

}  // namespace traverse::lidar
