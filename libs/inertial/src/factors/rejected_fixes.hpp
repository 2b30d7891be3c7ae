#pragma once

#include <deque>
#include <optional>

#include <Eigen/Core>

#include "traverse/geometry/stamp.hpp"

namespace traverse::inertial {

/// What fixes that were rejected one after the other say together. Each stands as predicted less
/// measured: fixes that agree with each other and with the motion of IMU and wheels lie on one line
/// over time, that of an estimate which is off by a place and a velocity.
class RejectedFixes {
 public:
  void add(geometry::Stamp stamp, const Eigen::Vector3d& residual,
           const Eigen::Matrix3d& covariance);
  void clear() { fixes_.clear(); }
  bool empty() const { return fixes_.empty(); }
  geometry::Stamp first_stamp() const { return fixes_.front().stamp; }
  const Eigen::Vector3d& first_residual() const { return fixes_.front().residual; }

  struct Line {
    Eigen::Vector3d offset;  ///< predicted less measured at the newest fix [m]
    Eigen::Vector3d slope;   ///< the same of the velocity [m/s]
    Eigen::Matrix3d of_fix;  ///< covariance of one fix, of which its scatter about the line is part
    Eigen::Matrix3d of_offset;
    Eigen::Matrix3d of_slope;
  };
  /// Nothing before they span `seconds` and are enough for a line and a scatter.
  std::optional<Line> line(double seconds) const;

 private:
  struct Fix {
    geometry::Stamp stamp;
    Eigen::Vector3d residual;
    Eigen::Matrix3d covariance;
  };
  std::deque<Fix> fixes_;
};

}  // namespace traverse::inertial
