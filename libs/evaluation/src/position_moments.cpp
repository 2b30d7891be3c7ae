#include "position_moments.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <fmt/format.h>

namespace traverse::evaluation {

namespace {

/// How far positions spread along their line and across it, root mean square.
struct Extent {
  double along_m = 0;
  double across_m = 0;

  explicit Extent(const Eigen::Matrix3d& moments) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments, Eigen::EigenvaluesOnly);
    const Eigen::Vector3d squares = solver.eigenvalues().cwiseMax(0);
    along_m = std::sqrt(squares[2]);
    across_m = std::sqrt(squares[0] + squares[1]);
  }
  double all_m() const { return std::hypot(along_m, across_m); }
};

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d S = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) S.z() = -1;
  return svd.matrixU() * S.asDiagonal() * svd.matrixV().transpose();
}

/// What w is in R - R^T = [w]x.
Eigen::Vector3d twice_skew_part(const Eigen::Matrix3d& R) {
  return {R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1)};
}

}  // namespace

PositionMoments::PositionMoments(const Poses& estimate, const Poses& reference, std::size_t used)
    : used_(used) {
  const auto n = static_cast<double>(used);
  for (std::size_t i = 0; i < used; ++i) {
    mean_x_ += estimate[i].translation;
    mean_y_ += reference[i].translation;
  }
  mean_x_ /= n;
  mean_y_ /= n;
  for (std::size_t i = 0; i < used; ++i) {
    const geometry::Pose3 x = estimate[i];
    const geometry::Pose3 y = reference[i];
    const Eigen::Vector3d dx = x.translation - mean_x_;
    const Eigen::Vector3d dy = y.translation - mean_y_;
    xx_ += dx * dx.transpose() / n;
    yy_ += dy * dy.transpose() / n;
    yx_ += dy * dx.transpose() / n;
    orientations_ += y.rotation * x.rotation.transpose() / n;
  }
  if (!(xx_.allFinite() && yy_.allFinite() && orientations_.allFinite())) {
    throw std::invalid_argument("alignment needs finite poses");
  }
  find_open();
}

void PositionMoments::find_open() {
  constexpr double kRounding = 1e-12;    // relative to where positions are
  constexpr double kCommon = 0.5;        // of the spread, to tell a rotation
  constexpr double kStraight = 0.02;     // across the line, relative to along it
  constexpr double kNoDeparture = 1e-6;  // the same, of a line that is exact

  const Extent x(xx_);
  const Extent y(yy_);
  const auto stands_still = [&](const Extent& extent, const Eigen::Vector3d& mean) {
    return extent.all_m() <= kRounding * std::max(1.0, mean.norm());
  };
  const bool x_still = stands_still(x, mean_x_);
  const bool y_still = stands_still(y, mean_y_);
  if (x_still || y_still) {
    open_ = Open::kAll;
    const char* which = x_still && y_still ? "both trajectories"
                        : x_still          ? "the estimate"
                                           : "the reference";
    reason_ = used_ == 1 ? "there is one position"
                         : fmt::format("the {} positions of {} are one point", used_, which);
    return;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(yx_, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d D = svd.singularValues();
  const bool mirrors = svd.matrixU().determinant() * svd.matrixV().determinant() < 0;
  const double common = (D[0] + D[1] + (mirrors ? -D[2] : D[2])) / (x.all_m() * y.all_m());
  if (!(common >= kCommon)) {
    open_ = Open::kAll;
    reason_ = fmt::format(
        "the positions of the two trajectories, spread by {:.3g} m and {:.3g} m, have {:.0f} % of "
        "it in common",
        x.all_m(), y.all_m(), 100 * common);
    return;
  }

  line_y_ = svd.matrixU().col(0);
  line_x_ = svd.matrixV().col(0);
  // Across the line the two planes are turned onto each other as well as they can be, at one scale.
  const Eigen::Matrix3d R0 =
      Eigen::Quaterniond::FromTwoVectors(line_x_, line_y_).toRotationMatrix();
  const double scale = y.along_m / x.along_m;
  const double x_across_m = scale * x.across_m;
  const Eigen::Matrix3d across = yx_ * R0.transpose();
  const double plane_trace = across.trace() - line_y_.dot(across * line_y_);
  const double in_common = scale * std::hypot(plane_trace, line_y_.dot(twice_skew_part(across)));
  const double apart_m =
      std::sqrt(std::max(0.0, x_across_m * x_across_m + y.across_m * y.across_m - 2 * in_common));
  const double least_m = std::min(x_across_m, y.across_m);
  const bool is_exact = least_m <= kNoDeparture * y.along_m;
  const bool is_noise = least_m <= kStraight * y.along_m && apart_m >= least_m;
  if (!is_exact && !is_noise) return;
  open_ = Open::kAboutLine;
  reason_ = fmt::format(
      "the {} positions of the {} lie on a line: they depart from it by {:.2g} m, and the two "
      "trajectories differ across it by {:.2g} m",
      used_, x_across_m < y.across_m ? "estimate" : "reference", least_m, apart_m);
}

Eigen::Matrix3d PositionMoments::rotation() const {
  if (open_ == Open::kNothing) return nearest_rotation(yx_);
  if (open_ == Open::kAll) return nearest_rotation(orientations_);
  const Eigen::Matrix3d R0 =
      Eigen::Quaterniond::FromTwoVectors(line_x_, line_y_).toRotationMatrix();
  const Eigen::Matrix3d left = orientations_ * R0.transpose();
  const double angle =
      std::atan2(line_y_.dot(twice_skew_part(left)), left.trace() - line_y_.dot(left * line_y_));
  return Eigen::AngleAxisd(angle, line_y_).toRotationMatrix() * R0;
}

geometry::Similarity PositionMoments::alignment(bool with_scale) const {
  geometry::Similarity result;
  result.T_y_x.rotation = rotation();
  if (with_scale && open_ != Open::kAll) {
    result.scale = (result.T_y_x.rotation.transpose() * yx_).trace() / xx_.trace();
  }
  result.T_y_x.translation = mean_y_ - result.scale * (result.T_y_x.rotation * mean_x_);
  return result;
}

}  // namespace traverse::evaluation
