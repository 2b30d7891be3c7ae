#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "traverse/geometry/pose3.hpp"
#include "traverse/lidar/corrected_scan.hpp"
#include "traverse/lidar/frame.hpp"
#include "traverse/optimization/factor_kind.hpp"
#include "traverse/sensors/imu_sample.hpp"
#include "traverse/sensors/lidar_scan.hpp"
#include "traverse/sensors/rig.hpp"
#include "traverse/sensors/wheel_odometry.hpp"

namespace traverse::lidar {

/// A point of the last scan and what it was registered on, for the eye.
struct MatchedPoint {
  enum class Kind { kLine, kPlane };

  Kind kind = Kind::kPlane;
  Eigen::Vector3d p_map;      ///< the point under the estimated pose, metres
  Eigen::Vector3d foot_map;   ///< the nearest point of the line or plane
  Eigen::Vector3d direction;  ///< unit: of the line, or the plane's normal; map frame
  double residual_m = 0;      ///< from foot_map to p_map; planes: positive on the normal's side
};

/// Something that an odometry decided or found out about a recording, in words.
struct Note {
  std::string name;
  std::string value;
  bool is_trouble = false;  ///< the result is less worth for it
  bool is_told = false;     ///< on the console too, under a short name
};

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

  /// Is told, before any measurement, what else there is and where: odometry of the lidar alone
  /// does not need it. \param lidar the sensor of `rig` whose scans it takes
  virtual void mount(const sensors::Rig& /*rig*/, const sensors::MountedSensor& /*lidar*/) {}

  /// Takes an inertial sample, its vectors turned into the lidar's axes, before the scans that end
  /// after it. Odometry that uses no IMU ignores it.
  virtual void observe(const sensors::ImuSample& /*sample_lidar*/) {}
  /// Whether it uses one.
  virtual bool uses_imu() const { return false; }

  /// Takes a reading of the wheels, as an IMU's. Odometry that uses no wheels ignores it.
  virtual void observe_wheels(const sensors::WheelOdometry& /*reading*/) {}
  /// Whether it uses them.
  virtual bool uses_wheels() const { return false; }

  /// What it decided beyond deskew_note(), for the run's record.
  virtual std::vector<Note> notes() const { return {}; }

  /// Names of the values in Frame::further: what this algorithm tells of a frame beyond what all
  /// do.
  virtual const std::vector<std::string>& further_columns() const {
    static const std::vector<std::string> kNone;
    return kNone;
  }

  /// Whether frames have a covariance.
  virtual bool tells_covariance() const { return false; }

  /// Whether scans are deskewed ("on"), and, if not, why.
  virtual const std::string& deskew_note() const = 0;

  /// The factors that it solves with; a run checks their Jacobians.
  virtual std::vector<optimization::FactorUse> factors() const { return {}; }

  /// The points of a scan as this algorithm uses them. \param velocity the frame's
  virtual CorrectedScan used_scan(const sensors::LidarScan& scan, const geometry::Twist& velocity,
                                  bool with_classes) const = 0;

  /// An independent copy: fed the same scans, both give the same bits. A copyable class makes one
  /// in one line: `return std::make_unique<ThisClass>(*this);`
  virtual std::unique_ptr<Odometry> clone() const = 0;

  /// About how much memory a copy takes.
  virtual std::size_t bytes() const = 0;

  /// The points that the next scan will be registered on, map frame; empty if there is no such map.
  virtual std::vector<Eigen::Vector3d> local_map() const { return {}; }

  /// How the last frame was registered; empty if that is not kept.
  virtual std::vector<MatchedPoint> matches() const { return {}; }
};

}  // namespace traverse::lidar
