#include "traverse/voxel_map/moments.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace traverse::voxel_map {

void Moments::forget_half() {
  for (float* value : {&n, &x, &y, &z, &xx, &xy, &xz, &yy, &yz, &zz}) *value *= 0.5F;
}

Eigen::Vector3d Moments::mean() const { return Eigen::Vector3d(x, y, z) / static_cast<double>(n); }

Eigen::Matrix3d Moments::covariance() const {
  Eigen::Matrix3d second;
  second << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  const Eigen::Vector3d m = mean();
  return second / static_cast<double>(n) - m * m.transpose();
}

std::optional<FittedPlane> fit_plane(const Moments& s, const PlaneFitOptions& options) {
  const double share = 1 / static_cast<double>(s.n);
  const double mx = s.x * share;
  const double my = s.y * share;
  const double mz = s.z * share;
  const double a = s.xx * share - mx * mx;
  const double b = s.xy * share - mx * my;
  const double c = s.xz * share - mx * mz;
  const double d = s.yy * share - my * my;
  const double e = s.yz * share - my * mz;
  const double f = s.zz * share - mz * mz;

  // l^3 - trace l^2 + minors l - determinant = 0, the smallest root.
  const double trace = a + d + f;
  const double minors = a * d - b * b + a * f - c * c + d * f - e * e;
  const double determinant = a * (d * f - e * e) - b * (b * f - e * c) + c * (b * e - d * c);
  double l0 = 0;
  for (int k = 0; k < 8; ++k) {
    const double value = ((l0 - trace) * l0 + minors) * l0 - determinant;
    const double slope = (3 * l0 - 2 * trace) * l0 + minors;
    if (slope <= 1e-18) break;
    const double step = value / slope;
    l0 -= step;
    if (std::abs(step) < 1e-7 * trace) break;
  }
  l0 = std::max(l0, 0.0);
  // The others from their sum and product.
  const double sum = trace - l0;
  const double product = minors - l0 * sum;
  const double l1 = 0.5 * (sum - std::sqrt(std::max(0.0, sum * sum - 4 * product)));
  const double thickness = options.thickness_m;
  const double width = options.min_width_m;
  if (!(l0 < options.flatness * l1 && l0 < thickness * thickness && l1 > width * width)) {
    return std::nullopt;
  }

  // The normal spans the kernel of C - l0 I: the longest cross product of two of its rows.
  const Eigen::Vector3d row_1(a - l0, b, c);
  const Eigen::Vector3d row_2(b, d - l0, e);
  const Eigen::Vector3d row_3(c, e, f - l0);
  Eigen::Vector3d normal = row_1.cross(row_2);
  for (const Eigen::Vector3d& other : {row_1.cross(row_3).eval(), row_2.cross(row_3).eval()}) {
    if (other.squaredNorm() > normal.squaredNorm()) normal = other;
  }
  if (normal.squaredNorm() < 1e-30) return std::nullopt;
  normal.normalize();
  const double offset = -(normal.x() * mx + normal.y() * my + normal.z() * mz);
  return FittedPlane{normal.cast<float>(), static_cast<float>(offset),
                     static_cast<float>(std::max(l0, 1e-8))};
}

std::optional<FittedLine> fit_line(const Moments& moments, const LineFitOptions& options) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(moments.covariance());
  const Eigen::Vector3d& l = solver.eigenvalues();
  const double length = options.min_length_m;
  if (!(l[1] < options.slenderness * l[2] && l[2] > length * length)) return std::nullopt;
  const Eigen::Vector3d direction = solver.eigenvectors().col(2).normalized();
  const Eigen::Vector3d e1 = direction.unitOrthogonal();
  const Eigen::Vector3d e2 = direction.cross(e1);
  const Eigen::Vector3d mean = moments.mean();
  return FittedLine{e1.cast<float>(), e2.cast<float>(), static_cast<float>(-e1.dot(mean)),
                    static_cast<float>(-e2.dot(mean)), static_cast<float>(std::max(l[1], 0.0))};
}

}  // namespace traverse::voxel_map
