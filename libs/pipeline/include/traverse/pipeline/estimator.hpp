#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/geodesy/local_tangent_plane.hpp"
#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/stamp.hpp"
#include "traverse/optimization/factor_kind.hpp"
#include "traverse/pipeline/health_reason.hpp"
#include "traverse/pipeline/sensor_use.hpp"
#include "traverse/pipeline/slam_map.hpp"
#include "traverse/sensors/measurement.hpp"
#include "traverse/sensors/rig.hpp"

namespace traverse::pipeline {

struct ForeignTiming;

/// What an estimator says of one moment of the recording.
struct PoseFrame {
  geometry::Stamp stamp;
  geometry::Pose3 T_map_body;
  geometry::Twist velocity = geometry::Twist::Zero();  ///< body twist a second: rad/s, m/s
  double milliseconds = 0;     ///< of wall time that the estimate took, reading not included
  std::vector<double> record;  ///< the health record: one value for each of columns()
};

/// A scan as the estimator used it: unusable points gone, corrected, deskewed.
struct UsedScan {
  std::vector<float> x, y, z;               ///< metres, body frame at the frame's stamp
  std::vector<float> intensity;             ///< 0 .. 1; empty, or one a point
  std::vector<std::uint8_t> feature_class;  ///< lidar::FeatureClass; empty, or one a point
  std::vector<std::uint32_t> source = {};   ///< index of the point in the LidarScan; may be empty
};

/// Something the estimator decided about a recording, and why: "deskew", "on".
struct Decision {
  std::string name;
  std::string value;
  bool is_told = false;  ///< on the console too
};

/// A point of the last scan on the line or plane of the map that it was registered on, map frame.
struct MatchedPoint {
  bool on_line = false;       ///< else on a plane
  Eigen::Vector3d p_map;      ///< metres, under the estimated pose
  Eigen::Vector3d foot_map;   ///< the nearest point of the line or plane
  Eigen::Vector3d direction;  ///< unit: of the line, or the plane's normal
  double residual_m = 0;      ///< from foot to point; on planes positive on the normal's side
};

/// An algorithm that turns measurements into poses. Its result depends on the measurements and its
/// configuration alone: not on the clock, not on the number of threads.
class Estimator {
 public:
  virtual ~Estimator() = default;

  /// Names of the health record's values, with the unit as suffix ("residual_rms_m").
  virtual const std::vector<std::string>& columns() const = 0;

  /// Where it may put what does not fit into memory; else the system's folder for temporary files.
  virtual void spill_to(const std::filesystem::path& /*folder*/) {}

  /// Whether its result is worth nothing without right readings of such a sensor.
  virtual bool depends_on(sensors::SensorKind kind) const {
    return kind == sensors::SensorKind::kLidar;
  }

  /// Takes the next measurement. \returns the frames that are now known, in order of time: often
  /// one, none for a measurement that completes no frame, several after a held-back start.
  virtual std::vector<PoseFrame> process(const sensors::Measurement& measurement) = 0;

  /// The frames still held back at the end of the recording.
  virtual std::vector<PoseFrame> finish() = 0;

  /// The scan of `frame` as it was used. \param with_classes also find its feature classes
  virtual UsedScan used_scan(const sensors::LidarScan& scan, const PoseFrame& frame,
                             bool with_classes) const = 0;

  /// What used_scan() does to points, in words: "elevation + 0.205 deg, deskewed".
  virtual std::string points_are() const = 0;

  virtual std::vector<Decision> decisions() const = 0;

  /// What became of the readings of the sensors that it takes: used, rejected and why; the run
  /// counts what was read. Complete after finish(). Sensors that it does not name are not used.
  virtual std::vector<SensorUse> sensor_use() const { return {}; }

  /// What went wrong that the frames' records do not tell, for the assessment of the run.
  virtual std::vector<HealthReason> troubles() const { return {}; }

  /// Unit vector to true north in the map frame, where the estimator ties the map to the earth.
  virtual std::optional<Eigen::Vector3d> north_map() const { return std::nullopt; }

  /// The factors that it solves with, if it does; a run checks their Jacobians.
  virtual std::vector<optimization::FactorUse> factors() const { return {}; }

  /// What became of the frames once loops were closed over them, if it closes loops. Complete after
  /// finish(). Frames are told by odometry alone, which loops do not disturb.
  virtual std::optional<SlamMap> slam_map() const { return std::nullopt; }

  /// An independent copy: fed the same measurements, both give the same bits (wall times aside).
  virtual std::unique_ptr<Estimator> clone() const = 0;

  /// About how much memory a copy takes, where it is more than a few kilobytes.
  virtual std::size_t bytes() const { return 0; }

  /// Of poses that another program made, what is known of that one's run; the frames then tell
  /// neither their times, unless it does, nor how they were found. Nothing: Traverse estimated.
  virtual std::optional<ForeignTiming> foreign() const;

  /// Where the map's origin is, x east and y north there; nothing if it is nowhere on Earth.
  virtual std::optional<geodesy::Geodetic> map_origin() const { return std::nullopt; }

  /// The points that the next scan will be registered on, map frame; empty if there is no such map.
  virtual std::vector<Eigen::Vector3d> local_map() const { return {}; }

  /// How the last frame was registered; empty if the estimator does not keep it.
  virtual std::vector<MatchedPoint> matches() const { return {}; }
};

}  // namespace traverse::pipeline
