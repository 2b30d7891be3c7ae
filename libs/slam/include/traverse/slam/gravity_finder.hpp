#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "traverse/config/binder.hpp"
#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/stamp.hpp"
#include "traverse/lidar/frame.hpp"
#include "traverse/sensors/imu_sample.hpp"

namespace traverse::slam {

struct GravityOptions {
  double window_s = 3;             ///< of driving that one direction of up is measured on
  double odometry_sigma_m = 0.01;  ///< of its positions, each frame for itself
  /// Of the vehicle's acceleration what is believed to remain: stamps, scale, mounting.
  double acceleration_share = 0.01;
  double min_sigma_deg = 1;
  double max_gap_s = 0.05;    ///< between samples; slower ones do not see how a vehicle shakes
  double max_off_m_s2 = 0.2;  ///< of the length found to that of gravity, beside what sigma tells
};
void bind(config::Binder& binder, GravityOptions& options);

/// Where odometry says that the lidar was.
struct OdometryMoment {
  geometry::Stamp stamp;
  geometry::Pose3 T_odom_lidar;
};

/// Up as an accelerometer and odometry see it together.
struct MeasuredUp {
  Eigen::Vector3d up_odom;  ///< unit, in the frame of odometry's map
  double sigma_rad = 0;
};

/// Finds up in what an accelerometer reads on the way, window by window.
///
/// It reads gravity and the vehicle's own acceleration. Weights c of the positions p(t) in a window
/// that add up to nothing on any straight line at constant speed measure an acceleration; by Taylor
/// with the remainder as an integral (Peano's kernel)
///
///     sum c_i p(t_i) = integral k(s) p''(s) ds,     k(s) = sum c_i max(t_i - s, 0):
///
/// so the readings, turned by odometry and averaged by the same k, less odometry's acceleration of
/// the place of the IMU, are gravity alone, however the vehicle moves. c are those of the parabola
/// that fits the positions best, which takes in least of their noise.
/// Derivation: docs/mathematics-pose-graph.md, section 3. A value.
class GravityFinder {
 public:
  GravityFinder(const GravityOptions& options, const geometry::Pose3& T_lidar_imu);

  void observe(const sensors::ImuSample& sample);
  /// Takes the next frame of odometry. \returns up, when a window has become full and could be used
  std::optional<MeasuredUp> add(const lidar::Frame& frame);

  std::size_t found() const { return found_; }
  /// Windows whose result has not the length of gravity.
  std::size_t turned_away() const { return turned_away_; }
  /// Windows with a gap between samples.
  std::size_t with_gaps() const { return with_gaps_; }

 private:
  std::optional<MeasuredUp> up_in_window();
  bool samples_cover_window() const;
  void forget_samples_before(geometry::Stamp stamp);

  GravityOptions options_;
  geometry::Pose3 T_lidar_imu_;
  std::deque<sensors::ImuSample> samples_;
  std::vector<OdometryMoment> window_;
  std::size_t found_ = 0;
  std::size_t turned_away_ = 0;
  std::size_t with_gaps_ = 0;
};

}  // namespace traverse::slam
