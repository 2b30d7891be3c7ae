#include <array>
#include <cmath>
#include <vector>

#include <Eigen/SVD>
#include <fmt/format.h>

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/so3.hpp"

#include "checks/check.hpp"

namespace traverse::plausibility {

namespace {

// Bodies that are fixed to each other turn alike: where one is mounted wrongly on paper, a rotation
// brings its turns onto those of the other (Kabsch, "A solution for the best rotation to relate two
// sets of vectors", 1976). Mountings by eye are good to ten degrees.
constexpr std::array<CodeMeaning, 1> kMountingCodes{
    {{"imu_mounting",
      "Turns by lidar odometry against those of a gyro in the body's axes, as vectors: "
      "a rotation of more than 15 degrees lies between that explains nine tenths of "
      "them."}}};

/// The rotation that brings the turns `from` onto `to`; about an axis that they all have in common
/// nothing is turned.
Eigen::Matrix3d rotation_between(const Eigen::Matrix3d& sum_to_from) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum_to_from,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d sizes = svd.singularValues();
  constexpr double kOneAxis = 0.05;
  if (sizes[1] < kOneAxis * sizes[0]) {
    return Eigen::Quaterniond::FromTwoVectors(svd.matrixV().col(0), svd.matrixU().col(0))
        .toRotationMatrix();
  }
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  signs.z() = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

Eigen::Vector3d roll_pitch_yaw_deg(const Eigen::Matrix3d& R) {
  return Eigen::Vector3d(std::atan2(R(2, 1), R(2, 2)), -std::asin(std::clamp(R(2, 0), -1.0, 1.0)),
                         std::atan2(R(1, 0), R(0, 0))) /
         geometry::kDegree;
}

void look_at_mounting(const View& view, std::vector<Finding>& findings) {
  const Evidence& evidence = view.evidence;
  constexpr double kPiece_s = 0.5;
  constexpr double kMinPiece = 0.05;  // rad; odometry is good to a hundredth of that
  constexpr double kMinTurn = 1;      // rad in all
  constexpr double kMaxAngle = 15 * geometry::kDegree;
  const Accumulated<3>& odometry = evidence.odometry.turn;
  if (odometry.empty()) return;
  for (const auto& [label, track] : evidence.imus) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    double turned = 0;
    double lengths = 0;  // sum of |found| |expected|
    const Eigen::Matrix3d R_body_imu = evidence.R_body(label);
    for (double t = odometry.begin_s(); t + kPiece_s <= odometry.end_s(); t += kPiece_s) {
      const auto expected = odometry.between(t, t + kPiece_s);
      const auto found = track.turn().between(t, t + kPiece_s);
      if (!expected || !found || expected->norm() < kMinPiece) continue;
      sum += *expected * (R_body_imu * *found).transpose();
      turned += expected->norm();
      lengths += expected->norm() * found->norm();
    }
    if (turned < kMinTurn || !(lengths > 0)) continue;
    const Eigen::Matrix3d R = rotation_between(sum);
    const double explained = (R.transpose() * sum).trace() / lengths;
    const double angle = geometry::angle_of(R);
    if (angle < kMaxAngle || explained < 0.9) continue;
    const Eigen::Vector3d rpy = roll_pitch_yaw_deg(R * R_body_imu);
    findings.push_back(
        {"imu_mounting", Severity::kWarn, label,
         fmt::format("its turns are rotated by {:.0f} deg from those of the lidar's odometry; that "
                     "rotation explains {:.0f} % of {:.0f} deg",
                     angle / geometry::kDegree, 100 * explained, turned / geometry::kDegree),
         "Turns and up would be taken about and along wrong axes",
         fmt::format("--recording \"vehicle.imu.roll_pitch_yaw_deg=[{:.0f}, {:.0f}, {:.0f}]\"",
                     rpy.x(), rpy.y(), rpy.z())});
  }
}

}  // namespace

const Check kImuMounting{kMountingCodes, look_at_mounting};

}  // namespace traverse::plausibility
