#include "traverse/loam/neighbourhood.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace traverse::loam {

namespace {

constexpr double kNoise = 0.05;  // metres: below, the shape across a line is that of the noise

struct PrincipalComponents {
  Eigen::Vector3d mean;
  Eigen::Vector3d eigenvalues;   // ascending, m^2
  Eigen::Matrix3d eigenvectors;  // columns
};

PrincipalComponents principal_components(std::span<const Eigen::Vector3d> points) {
  PrincipalComponents pca;
  pca.mean.setZero();
  for (const auto& p : points) pca.mean += p;
  pca.mean /= static_cast<double>(points.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto& p : points) {
    const Eigen::Vector3d d = p - pca.mean;
    covariance += d * d.transpose();
  }
  covariance /= static_cast<double>(points.size());
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  pca.eigenvalues = solver.eigenvalues().cwiseMax(0);
  pca.eigenvectors = solver.eigenvectors();
  return pca;
}

}  // namespace

void bind(config::Binder& b, NeighbourhoodOptions& o) {
  using config::Range;
  b.number("line_ratio", o.line_ratio, Range::between(1, 1e6),
           "a line's largest eigenvalue is at least this times the second");
  b.number("line_flatness", o.line_flatness, Range::between(1, 1e6),
           "a line's second eigenvalue is at most this times the smallest");
  b.number("line_thickness_m", o.line_thickness_m, Range::positive(),
           "largest distance of a neighbour from its line");
  b.number("plane_thickness_m", o.plane_thickness_m, Range::positive(),
           "largest distance of a neighbour from its plane");
  b.number("plane_spread", o.plane_spread, Range::between(0, 1),
           "a plane's second eigenvalue is at least this times the largest");
}

std::optional<Line> fit_line(std::span<const Eigen::Vector3d> points,
                             const NeighbourhoodOptions& options) {
  const PrincipalComponents pca = principal_components(points);
  if (!(pca.eigenvalues[2] > options.line_ratio * pca.eigenvalues[1])) return std::nullopt;
  const bool strip = pca.eigenvalues[1] > options.line_flatness * pca.eigenvalues[0] &&
                     pca.eigenvalues[1] > kNoise * kNoise;
  if (strip) return std::nullopt;
  const Line line{pca.mean, pca.eigenvectors.col(2).normalized()};
  const bool thin = std::all_of(points.begin(), points.end(), [&](const Eigen::Vector3d& p) {
    return line_distance_residual(line, p) <= options.line_thickness_m;
  });
  if (!thin) return std::nullopt;
  return line;
}

std::optional<Plane> fit_plane(std::span<const Eigen::Vector3d> points,
                               const NeighbourhoodOptions& options) {
  const PrincipalComponents pca = principal_components(points);
  if (!(pca.eigenvalues[1] > options.plane_spread * pca.eigenvalues[2])) return std::nullopt;
  Plane plane;
  plane.normal = pca.eigenvectors.col(0).normalized();
  plane.offset = -plane.normal.dot(pca.mean);
  const bool thin = std::all_of(points.begin(), points.end(), [&](const Eigen::Vector3d& p) {
    return std::abs(plane_residual(plane, p)) <= options.plane_thickness_m;
  });
  if (!thin) return std::nullopt;
  return plane;
}

}  // namespace traverse::loam
