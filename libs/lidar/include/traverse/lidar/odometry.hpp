#pragma once

#include <string>
#include <vector>

#include "traverse/geometry/pose3.hpp"
#include "traverse/lidar/corrected_scan.hpp"
#include "traverse/lidar/frame.hpp"
#include "traverse/optimization/factor_kind.hpp"
#include "traverse/sensors/imu_sample.hpp"
#include "traverse/sensors/lidar_scan.hpp"

namespace traverse::lidar {

/// An algorithm that follows a lidar from scan to scan. Everything is in the lidar's own frame; the
/// map frame is that of the first scan. The result depends on the scans and the options alone.
class Odometry {
 public:
  virtual ~Odometry() = default;

  /// Takes the next scan; stamps must increase. \returns the frames that are now known, in order:
  /// usually one, none while the start is held back, several when it ends.
  /// \throws sensors::NoRings if the scan cannot be divided into scan lines and the algorithm
  /// needs them.
  virtual std::vector<Frame> process(const sensors::LidarScan& scan) = 0;

  /// The frames still held back when the recording ends early.
  virtual std::vector<Frame> finish() = 0;

  /// Takes an inertial sample, its vectors turned into the lidar's axes, before the scans that end
  /// after it. Odometry that uses no IMU ignores it.
  virtual void observe(const sensors::ImuSample& /*sample_lidar*/) {}

  /// Whether scans are deskewed ("on"), and, if not, why.
  virtual const std::string& deskew_note() const = 0;

  /// The factors that it solves with; a run checks their Jacobians.
  virtual std::vector<optimization::FactorUse> factors() const { return {}; }

  /// The points of a scan as this algorithm uses them. \param velocity the frame's
  virtual CorrectedScan used_scan(const sensors::LidarScan& scan, const geometry::Twist& velocity,
                                  bool with_classes) const = 0;
};

}  // namespace traverse::lidar
