#pragma once

#include <deque>
#include <optional>

#include <Eigen/Core>

#include "traverse/geometry/stamp.hpp"

namespace traverse::inertial {

/// Standard deviations of fixes that tell none, by how much they scatter.
///
/// What the fixes tell less what the IMU integrates to, from an unknown place and velocity and with
/// a tilt that errs, is a polynomial of second degree in time; the third divided difference takes
/// that away and leaves the noise of the fixes. Before attitude is known the IMU has no part in it:
/// the vehicle's own jerk is then taken for noise too, 2 mm for 10 m/s^3 at 10 Hz. The median of
/// the last differences is none of outliers and steps. What fixes err by for seconds on end it does
/// not see: that is GnssOptions::bias_horizontal_m.
class FixScatter {
 public:
  /// What the IMU says of a step. \param dv_map  change of velocity [m/s]
  void add_motion(double seconds, const Eigen::Vector3d& dv_map);
  /// \param arm_map  of the antenna from the IMU, in the map [m]
  void add(geometry::Stamp stamp, const Eigen::Vector3d& p_antenna_map,
           const Eigen::Vector3d& arm_map);
  /// The IMU's part begins, or begins anew.
  void forget_path() { last_.clear(); }

  struct Sigma {
    double horizontal_m = 0;
    double vertical_m = 0;
  };
  /// Nothing before there are kLeast differences.
  std::optional<Sigma> sigma() const;
  std::size_t fixes() const { return differences_.size(); }

  static constexpr std::size_t kLeast = 10;

 private:
  struct Point {
    geometry::Stamp stamp;
    Eigen::Vector3d e;
  };
  std::deque<Point> last_;
  std::deque<Eigen::Vector3d> differences_;  ///< scaled to the deviation of one fix [m]
  Eigen::Vector3d v_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_ = Eigen::Vector3d::Zero();
};

}  // namespace traverse::inertial
