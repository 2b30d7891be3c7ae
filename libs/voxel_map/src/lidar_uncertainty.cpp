#include "traverse/voxel_map/lidar_uncertainty.hpp"

namespace traverse::voxel_map {

using lidar::Matrix6;

namespace {

Matrix6 axes_of(const Eigen::Matrix3d& rotation) {
  Matrix6 axes = Matrix6::Zero();
  axes.topLeftCorner<3, 3>() = rotation;
  axes.bottomRightCorner<3, 3>() = rotation;
  return axes;
}

/// The part of a body twist that the matches do not determine.
Matrix6 unseen_part(const lidar::Observability& seen) {
  Matrix6 to_scaled = Matrix6::Identity();
  to_scaled.topLeftCorner<3, 3>() *= seen.rotation_scale_m;
  Matrix6 from_scaled = Matrix6::Identity();
  from_scaled.topLeftCorner<3, 3>() /= seen.rotation_scale_m;
  const auto unseen = seen.directions.leftCols(seen.degenerate);
  return from_scaled * unseen * unseen.transpose() * to_scaled;
}

}  // namespace

Matrix6 LidarUncertainty::first_change() {
  constexpr double kTurn = 0.01;  // rad/s from scan to scan
  constexpr double kSpeed = 0.1;  // m/s
  Matrix6 change = Matrix6::Zero();
  change.diagonal().head<3>().setConstant(kTurn * kTurn);
  change.diagonal().tail<3>().setConstant(kSpeed * kSpeed);
  return change;
}

void LidarUncertainty::add(ScanEvidence evidence, const lidar::Observability& seen,
                           const geometry::Pose3& T_map_lidar, const geometry::Twist& speed_change,
                           double seconds) {
  constexpr double kAlike = 0.9;        // scans within a second
  constexpr double kRemembered = 0.99;  // scans of the last ten seconds
  if (seen.degenerate == 0) {
    changing_ = kAlike * changing_ + speed_change;
    changing_weight_ = kAlike * kAlike * changing_weight_ + 1;
    change_weight_ = kRemembered * change_weight_ + 1;
    change_ += (changing_ * changing_.transpose() / changing_weight_ - change_) / change_weight_;
    speed_.setZero();
    pose_by_speed_.setZero();
    pose_.add(evidence, T_map_lidar, true, Matrix6::Zero(), Matrix6::Zero());
    return;
  }
  const Matrix6 unseen = unseen_part(seen);
  const Matrix6 axes = axes_of(T_map_lidar.rotation);
  const Matrix6 unseen_map = axes * unseen * axes.transpose();
  const Matrix6 seen_map = Matrix6::Identity() - unseen_map;
  evidence.keep(seen_map, seen_map);
  // Of any size: the evidence has nothing there.
  const double size = evidence.information.trace();
  pose_.add(evidence, T_map_lidar, true, size * unseen_map.transpose() * unseen_map,
            growth(T_map_lidar, unseen, seconds));
}

void LidarUncertainty::add_predicted(const geometry::Pose3& T_map_lidar, double seconds) {
  pose_.add_prediction(growth(T_map_lidar, Matrix6::Identity(), seconds));
}

/// Of the covariance of the pose, a twist about the map's origin, while `unseen` goes on at a speed
/// that is less and less known.
Matrix6 LidarUncertainty::growth(const geometry::Pose3& T_map_lidar, const Matrix6& unseen,
                                 double seconds) {
  const Matrix6 to_map = about_the_origin(T_map_lidar) * axes_of(T_map_lidar.rotation);
  speed_ = (unseen * (speed_ + change_) * unseen.transpose()).eval();
  pose_by_speed_ = (pose_by_speed_ * unseen.transpose()).eval();
  const Matrix6 mixed = seconds * pose_by_speed_ * to_map.transpose();
  const Matrix6 grown =
      mixed + mixed.transpose() + seconds * seconds * to_map * speed_ * to_map.transpose();
  pose_by_speed_ += seconds * to_map * speed_;
  return grown;
}

}  // namespace traverse::voxel_map
