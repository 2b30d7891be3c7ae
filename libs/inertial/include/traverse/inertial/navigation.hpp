#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/geodesy/local_tangent_plane.hpp"
#include "traverse/inertial/nav_state.hpp"
#include "traverse/inertial/navigation_options.hpp"
#include "traverse/inertial/wheel_mount.hpp"
#include "traverse/sensors/gnss_fix.hpp"
#include "traverse/sensors/imu_sample.hpp"
#include "traverse/sensors/wheel_encoder.hpp"
#include "traverse/sensors/wheel_odometry.hpp"

namespace traverse::inertial {

/// Where the other sensors are, in the IMU's frame.
struct Mounts {
  Eigen::Vector3d antenna_body = Eigen::Vector3d::Zero();  ///< m
  double baseline_angle = 0;  ///< of two antennas from the x axis, counterclockwise [rad]
  WheelMount wheels;
  std::optional<sensors::WheelEncoder> encoder;
};

/// The chi-square of what a factor kind said of a state before it was taken, with the rows it has;
/// of the inertial factor, of the state that the IMU predicted against all that was then taken.
struct Innovation {
  double chi2 = 0;
  int rows = 0;  ///< 0: there was none
  bool is_rejected = false;
};

/// What is known of one moment, and how well.
struct NavFrame {
  NavState state;
  NavState::Matrix covariance = NavState::Matrix::Zero();  ///< in the tangent of the state
  bool by_gnss = false;                                    ///< what made the state, or joined it
  bool by_wheels = false;
  bool in_outage = false;
  bool restarted = false;  ///< what was known was given up, and navigation began again here
  Innovation gnss, heading, wheels, standing, inertial;
  Eigen::Vector3d gnss_residual_enu = Eigen::Vector3d::Zero();  ///< predicted - measured, m
  /// Where the fix puts the antenna, m; of a frame whose gnss has rows.
  Eigen::Vector3d p_antenna_fix_map = Eigen::Vector3d::Zero();
  /// By how much the solution moved the state from where the state before led to, m: of a path that
  /// is given out as it is found, its jumps.
  Eigen::Vector3d correction_map = Eigen::Vector3d::Zero();
  double outage_error_m = 0;     ///< horizontal, at the first fix after one; else 0
  double outage_distance_m = 0;  ///< travelled in it
  int iterations = 0;
  bool converged = false;  ///< the last solution: its last step was below window.converged_step
  int states = 0;
};

/// How a spell without fixes ended.
struct OutageResult {
  double seconds = 0;
  double distance_m = 0;  ///< travelled
  double error_m = 0;     ///< horizontal, to the first fix after it
  double sigma_m = 0;     ///< that the estimate gave itself, horizontal
};

/// Something that was found out, in words.
struct Fact {
  std::string name;
  std::string value;
};

/// A navigation estimator on IMU pre-integration, GNSS and wheels: a fixed-lag smoother over a
/// chain of states, which readings make as NavigationOptions::trigger says. With a window of two
/// states, each of which keeps its constraints while it is there, it is the two-frame estimator of
/// Gao Xiang, "SLAM in autonomous driving", chapter 4, and of the exercises on it:
///   GNSS then GNSS    a GNSS factor on both states
///   GNSS then wheels  GNSS on the last and velocity on this
///   wheels then wheels  velocity on both
///   wheels then GNSS  velocity on the last and GNSS on this
/// Mended: no measurement is counted twice (a state's own factors join the prior when it leaves,
/// not before), the prior is the true marginal, biases and gravity of the start are used, the
/// covariance does not depend on the IMU's rate.
///
/// Readings come in the order of their stamps; what comes late is counted and not used. Between
/// IMU samples readings are interpolated. Earth's rotation is not modelled: the gyro bias takes it.
class Navigation {
 public:
  Navigation(const NavigationOptions& options, const Mounts& mounts);
  Navigation(const Navigation& other);
  ~Navigation();

  /// \returns the frames that are now complete, oldest first
  std::vector<NavFrame> add(const sensors::ImuSample& sample);  ///< in the body's axes
  std::vector<NavFrame> add(const sensors::GnssFix& fix);
  std::vector<NavFrame> add(const sensors::WheelOdometry& reading);
  std::vector<NavFrame> finish();

  /// How it began, and why not if it did not.
  std::string start_note() const;
  /// The map's origin; nothing without a fix.
  const std::optional<geodesy::LocalTangentPlane>& plane() const;
  /// What was not used or not usual, by what it was: "fix rejected by chi-square".
  const std::map<std::string, std::size_t>& events() const;
  const std::vector<OutageResult>& outages() const;
  /// What was taken for true and who says so: the deviation of fixes that tell none.
  std::vector<Fact> facts() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace traverse::inertial
