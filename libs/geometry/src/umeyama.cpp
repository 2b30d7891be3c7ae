#include "traverse/geometry/umeyama.hpp"

#include <limits>

#include <Eigen/SVD>

namespace traverse::geometry {

Similarity umeyama(std::span<const Eigen::Vector3d> x, std::span<const Eigen::Vector3d> y,
                   bool with_scale) {
  if (x.size() != y.size()) {
    throw std::invalid_argument("alignment needs two point sets of one size");
  }
  return umeyama(
      x.size(), [&](std::size_t i) { return x[i]; }, [&](std::size_t i) { return y[i]; },
      with_scale);
}

Similarity umeyama(std::size_t count, const std::function<Eigen::Vector3d(std::size_t)>& x,
                   const std::function<Eigen::Vector3d(std::size_t)>& y, bool with_scale) {
  if (count == 0) throw std::invalid_argument("alignment needs points");
  const auto n = static_cast<double>(count);
  Eigen::Vector3d mean_x = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_y = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    mean_x += x(i);
    mean_y += y(i);
  }
  mean_x /= n;
  mean_y /= n;

  double variance_x = 0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d from_mean = x(i) - mean_x;
    variance_x += from_mean.squaredNorm();
    covariance += (y(i) - mean_y) * from_mean.transpose();
  }
  variance_x /= n;
  covariance /= n;

  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.info() != Eigen::Success) {
    throw std::invalid_argument("alignment needs finite positions");
  }
  const Eigen::Vector3d D = svd.singularValues();
  if ((D.array() > std::numeric_limits<double>::epsilon()).count() < 2) {
    throw DegenerateAlignment("the positions lie on one point or one line: no unique alignment");
  }
  Eigen::Vector3d S = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) S.z() = -1;  // no mirror image

  Similarity result;
  result.T_y_x.rotation = svd.matrixU() * S.asDiagonal() * svd.matrixV().transpose();
  result.scale = with_scale ? D.dot(S) / variance_x : 1;
  result.T_y_x.translation = mean_y - result.scale * (result.T_y_x.rotation * mean_x);
  return result;
}

}  // namespace traverse::geometry
