#include "level_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "traverse/geometry/umeyama.hpp"

namespace traverse::pose_graph {

namespace {

/// Standard deviation along the longest axis.
double spread_of(std::span<const Eigen::Vector3d> points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& p : points) scatter += (p - mean) * (p - mean).transpose();
  scatter /= static_cast<double>(points.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, axes.eigenvalues().maxCoeff()));
}

}  // namespace

std::optional<geometry::Pose3> level_alignment(std::span<const Eigen::Vector3d> antennas_map,
                                               std::span<const Eigen::Vector3d> antennas_enu,
                                               const Eigen::Vector3d& up_map, double spread) {
  if (antennas_map.size() < 2) return std::nullopt;
  const double height = spread_of(antennas_enu);
  if (height < spread || spread_of(antennas_map) < spread) return std::nullopt;
  std::vector<Eigen::Vector3d> from(antennas_map.begin(), antennas_map.end());
  std::vector<Eigen::Vector3d> to(antennas_enu.begin(), antennas_enu.end());
  for (const auto& p : antennas_map) from.emplace_back(p + height * up_map);
  for (const auto& p : antennas_enu) to.emplace_back(p + height * Eigen::Vector3d::UnitZ());
  try {
    return geometry::umeyama(from, to, false).T_y_x;
  } catch (const geometry::DegenerateAlignment&) {
    return std::nullopt;  // straight up
  }
}

}  // namespace traverse::pose_graph
