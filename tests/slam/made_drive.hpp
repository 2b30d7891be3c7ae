#pragma once

#include <vector>

#include "traverse/geometry/so3.hpp"
#include "traverse/lidar/frame.hpp"
#include "traverse/simulation/scanner.hpp"
#include "traverse/simulation/worlds.hpp"
#include "traverse/slam/keyframe_maker.hpp"
#include "traverse/voxel_map/used_points.hpp"

namespace traverse::testing {

/// A coarse lidar, so that tests are quick.
inline simulation::Scanner coarse_scanner() {
  simulation::Scanner scanner = simulation::demo_scanner();
  scanner.azimuth_steps = 600;
  std::vector<double> beams;
  for (std::size_t i = 0; i < scanner.profile.elevations_deg.size(); i += 2) {
    beams.push_back(scanner.profile.elevations_deg[i]);
  }
  scanner.profile.elevations_deg = beams;
  scanner.profile.rings = static_cast<int>(beams.size());
  return scanner;
}

/// The health of a registration as it goes on an ordinary street.
inline lidar::RegistrationHealth good_health() {
  lidar::RegistrationHealth health;
  health.registered = true;
  health.plane_matches = 1000;
  health.line_matches = 100;
  health.residual_rms_m = 0.03;
  health.observability.eigenvalues.setConstant(0.1);
  health.observability.rotation_scale_m = 10;
  return health;
}

/// A scan of a street and the frame that an odometry with some error told of it.
struct MadeFrame {
  sensors::LidarScan scan;
  lidar::Frame frame;
  geometry::Pose3 T_truth;  ///< T_street_lidar
};

/// Passes through one street, each `seconds` long at 10 m/s, a scan every fifth of a second.
/// Odometry errs by a twist `drift` each frame.
class MadeDrive {
 public:
  explicit MadeDrive(const geometry::Twist& drift) : drift_(drift) {}

  void pass(double seconds, const simulation::Drive& drive) {
    const auto scans = static_cast<std::size_t>(seconds * 5);
    for (std::size_t i = 0; i < scans; ++i) {
      const double t = 0.2 * static_cast<double>(i);
      MadeFrame made;
      made.scan = scanner_.scan(street_, drive, t);
      made.scan.sensor = "lidar";
      made.T_truth = drive.pose(t);
      const geometry::Pose3 moved = frames_.empty()
                                        ? geometry::Pose3::identity()
                                        : frames_.back().T_truth.inverse() * made.T_truth;
      made.frame.T_map_lidar =
          frames_.empty() ? moved
                          : frames_.back().frame.T_map_lidar * moved * geometry::exp_se3(drift_);
      made.frame.index = frames_.size();
      made.frame.stamp = geometry::Stamp::from_seconds(0.2 * static_cast<double>(frames_.size()));
      made.scan.stamp = made.frame.stamp;
      made.frame.velocity =
          geometry::log_se3(drive.pose(t - 0.05).inverse() * drive.pose(t + 0.05)) / 0.1;
      made.frame.health = good_health();
      frames_.push_back(std::move(made));
    }
  }

  const std::vector<MadeFrame>& frames() const { return frames_; }
  const sensors::LidarProfile& profile() const { return scanner_.profile; }

 private:
  geometry::Twist drift_;
  simulation::Scanner scanner_ = coarse_scanner();
  simulation::AnalyticScene street_ = simulation::street(60, 1);
  std::vector<MadeFrame> frames_;
};

inline lidar::CorrectedScan points_of(const MadeFrame& made, const sensors::LidarProfile& profile) {
  return voxel_map::used_points(made.scan, profile, made.frame.velocity);
}

}  // namespace traverse::testing
