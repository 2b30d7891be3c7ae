#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "traverse/evaluation/consistency.hpp"
#include "traverse/evaluation/statistics.hpp"
#include "traverse/statistics/quantile.hpp"

namespace traverse::evaluation {

/// Zeroth to second moments of points about the query.
class Moments {
 public:
  void add(double x, double y, double z) {
    ++count_;
    x_ += x;
    y_ += y;
    z_ += z;
    xx_ += x * x;
    xy_ += x * y;
    xz_ += x * z;
    yy_ += y * y;
    yz_ += y * z;
    zz_ += z * z;
  }

  std::size_t count() const { return count_; }
  Eigen::Vector3d mean() const { return Eigen::Vector3d(x_, y_, z_) / static_cast<double>(count_); }
  Eigen::Matrix3d covariance() const {
    Eigen::Matrix3d second;
    second << xx_, xy_, xz_, xy_, yy_, yz_, xz_, yz_, zz_;
    return second / static_cast<double>(count_) - mean() * mean().transpose();
  }

 private:
  std::size_t count_ = 0;
  double x_ = 0, y_ = 0, z_ = 0;
  double xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0;
};

/// Collects the figures of the queries.
class ConsistencyTotals {
 public:
  /// `all` neighbours of a query, and those that scans `far` enough away saw.
  void add(const Moments& all, const Moments& far) {
    if (all.count() < consistency::kFewestNeighbours) return;
    const Eigen::Matrix3d covariance = all.covariance();
    eigen_.compute(covariance, Eigen::EigenvaluesOnly);
    const double determinant = std::max(covariance.determinant(), kSmallestDeterminant);
    entropy_ +=
        0.5 * (3 * std::log(2 * std::numbers::pi * std::numbers::e) + std::log(determinant));
    plane_deviation_m_ += std::sqrt(std::max(0.0, eigen_.eigenvalues()[0]));
    ++queries_;
    if (far.count() < consistency::kFewestNeighbours) return;
    eigen_.compute(far.covariance());
    const Eigen::Vector3d& l = eigen_.eigenvalues();
    if (!(l[0] < 0.05 * l[1] && l[1] > 0.1 * l[2])) return;
    distances_m_.push_back(std::abs(eigen_.eigenvectors().col(0).dot(far.mean())));
  }

  std::optional<Consistency> result() const {
    if (queries_ == 0) return std::nullopt;
    Consistency result;
    result.queries = queries_;
    result.mme = entropy_ / static_cast<double>(queries_);
    result.mpv_m = plane_deviation_m_ / static_cast<double>(queries_);
    if (!distances_m_.empty()) {
      const Statistics statistics = statistics_of(distances_m_);
      result.point_to_plane = {distances_m_.size(), statistics.mean, statistics.median,
                               statistics::quantile(distances_m_, 0.9)};
    }
    return result;
  }

 private:
  static constexpr double kSmallestDeterminant = 1e-18;  // m^6: of a patch without thickness

  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen_;
  double entropy_ = 0;
  double plane_deviation_m_ = 0;
  std::size_t queries_ = 0;
  std::vector<double> distances_m_;
};

}  // namespace traverse::evaluation
