#pragma once

#include <deque>
#include <optional>

#include <Eigen/Core>

#include "traverse/config/binder.hpp"
#include "traverse/geometry/stamp.hpp"
#include "traverse/sensors/imu_sample.hpp"

namespace traverse::loam {

struct ImuOptions {
  bool use = false;             ///< where the recording has an IMU
  double longest_gap_s = 0.15;  ///< without samples, that is bridged
};
void bind(config::Binder& binder, ImuOptions& options);

/// The rotation of the lidar between two moments, from the angular rates of an IMU in the lidar's
/// axes, linear between samples. Accelerations are not used: over the tenth of a second between
/// scans the velocity that scans gave is better than what a cheap accelerometer, whose bias and
/// tilt nobody has estimated, would add to it.
class ImuPrediction {
 public:
  explicit ImuPrediction(const ImuOptions& options);

  /// Whether samples are used at all.
  bool is_used() const { return options_.use; }

  /// A sample that is not later than the one before or has a rate that is not finite is ignored.
  void observe(const sensors::ImuSample& sample_lidar);

  /// Rotation vector [rad] of R_from_to: the product of Exp(rate dt) over the samples. Before the
  /// first and after the last sample their rates hold for up to `longest_gap_s`. Nothing if that,
  /// or the gap between two samples, is longer, if from > to, or if the IMU is not to be used.
  std::optional<Eigen::Vector3d> rotation(geometry::Stamp from, geometry::Stamp to) const;

  /// Samples that no interval from `stamp` on needs are dropped.
  void forget_before(geometry::Stamp stamp);

 private:
  ImuOptions options_;
  std::deque<sensors::ImuSample> samples_;
};

}  // namespace traverse::loam
