#include "traverse/voxel_map/pose_uncertainty.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

#include "traverse/geometry/so3.hpp"

namespace traverse::voxel_map {

using lidar::Matrix6;
using lidar::Vector6;

namespace {

/// Of the squares of what the pose moves by without each part in turn.
constexpr double kJackknife =
    static_cast<double>(ScanEvidence::kParts - 1) / static_cast<double>(ScanEvidence::kParts);

/// By how much the pose would move without a part, but for its sign: at the pose found a part has
/// spent of its pull what it has brought the pose by.
Vector6 shift_without(std::size_t part, const ScanEvidence& evidence, const Matrix6& all) {
  constexpr double kMost = 0.9;  // of a part that alone tells of a direction
  return (all - kMost * evidence.information_of[part]).llt().solve(evidence.pull[part]);
}

Matrix6 to_lidar_axes(const geometry::Pose3& T_map_lidar) {
  Matrix6 axes = Matrix6::Zero();
  axes.topLeftCorner<3, 3>() = T_map_lidar.rotation.transpose();
  axes.bottomRightCorner<3, 3>() = T_map_lidar.rotation.transpose();
  return axes;
}

Matrix6 about_the_lidar(const geometry::Pose3& T_map_lidar) {
  Matrix6 moved = Matrix6::Identity();
  moved.bottomLeftCorner<3, 3>() = -geometry::hat(T_map_lidar.translation);
  return moved;
}

}  // namespace

Matrix6 about_the_origin(const geometry::Pose3& T_map_lidar) {
  Matrix6 moved = Matrix6::Identity();
  moved.bottomLeftCorner<3, 3>() = geometry::hat(T_map_lidar.translation);
  return moved;
}

PoseUncertainty::PoseUncertainty() { drift_.fill(Vector6::Zero()); }

void PoseUncertainty::add(const ScanEvidence& evidence, const geometry::Pose3& T_map_lidar,
                          bool enters_map, const Matrix6& prediction, const Matrix6& growth) {
  constexpr double kRemembered = 50;  // scans
  const Eigen::LLT<Matrix6> lasting(evidence.aged + prediction);
  const Matrix6 all = evidence.information + prediction;
  if (lasting.info() != Eigen::Success || all.llt().info() != Eigen::Success) {
    return;
  }
  const Matrix6 moved = about_the_origin(T_map_lidar);
  const Matrix6 axes = to_lidar_axes(T_map_lidar);
  const Matrix6 lasts = moved * lasting.solve(all);
  Matrix6 own = Matrix6::Zero();
  for (std::size_t part = 0; part < drift_.size(); ++part) {
    if (evidence.pull[part].isZero(0)) continue;
    const Vector6 shift = shift_without(part, evidence, all);
    if (enters_map) drift_[part] -= lasts * shift;
    own.selfadjointView<Eigen::Lower>().rankUpdate(shift, kJackknife);
  }
  own = (axes * Matrix6(own.selfadjointView<Eigen::Lower>()) * axes.transpose()).eval();
  own_weight_ = std::min(own_weight_ + 1, kRemembered);
  own_ += (own - own_) / own_weight_;
  // What the prediction's own growth leaves in the map.
  const Matrix6 kept = moved * lasting.solve(prediction) * about_the_lidar(T_map_lidar);
  predicted_ += kept * growth * kept.transpose();
}

Matrix6 PoseUncertainty::covariance_of_map(const geometry::Pose3& T_map_lidar) const {
  Matrix6 map = predicted_;
  for (const Vector6& drift : drift_) map += kJackknife * drift * drift.transpose();
  const Matrix6 to_lidar = to_lidar_axes(T_map_lidar) * about_the_lidar(T_map_lidar);
  return to_lidar * map * to_lidar.transpose();
}

Matrix6 PoseUncertainty::covariance(const geometry::Pose3& T_map_lidar) const {
  return covariance_of_map(T_map_lidar) + own_;
}

}  // namespace traverse::voxel_map
