#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "traverse/geodesy/local_tangent_plane.hpp"
#include "traverse/geometry/trajectory.hpp"
#include "traverse/pipeline/estimator.hpp"
#include "traverse/slam/gravity_finder.hpp"
#include "traverse/slam/slam.hpp"

#include "lidar_estimator.hpp"

namespace traverse::pipeline {

struct SlamGnssOptions {
  bool use = true;     ///< fixes of the recording's first receiver, where it has one
  double sigma_m = 3;  ///< of a fix that does not tell its covariance
  double min_sigma_m = 0.02;
};

struct SlamGravityOptions {
  bool use = true;  ///< the recording's first IMU, where it has one
  slam::GravityOptions finder;
};

/// Loops over an odometry, and what else its graph takes.
struct SlamEstimatorOptions {
  bool use = false;  ///< off: odometry alone
  SlamGnssOptions gnss;
  SlamGravityOptions gravity;
  slam::SlamOptions slam;
};
void bind(config::Binder& binder, SlamEstimatorOptions& options);

/// A lidar odometry and the loops that are closed over it. The frames it tells are odometry's, with
/// two more columns in the health record and the time that keyframes and loops took;
/// slam_map() corrects them.
class SlamEstimator final : public Estimator {
 public:
  SlamEstimator(std::unique_ptr<LidarEstimator> odometry, const dataset::RecordingInfo& recording,
                const SlamEstimatorOptions& options);

  const std::vector<std::string>& columns() const override { return columns_; }
  void spill_to(const std::filesystem::path& folder) override { slam_.spill_to(folder); }
  std::vector<PoseFrame> process(const sensors::Measurement& measurement) override;
  std::vector<PoseFrame> finish() override;
  UsedScan used_scan(const sensors::LidarScan& scan, const PoseFrame& frame,
                     bool with_classes) const override {
    return odometry_->used_scan(scan, frame, with_classes);
  }
  std::string points_are() const override { return odometry_->points_are(); }
  std::vector<Decision> decisions() const override;
  std::vector<SensorUse> sensor_use() const override;
  std::vector<HealthReason> troubles() const override;
  std::vector<optimization::FactorUse> factors() const override;
  std::optional<SlamMap> slam_map() const override {
    std::optional<geodesy::Geodetic> origin;
    if (slam_.graph().is_georeferenced()) origin = plane_->origin();
    return SlamMap(slam_, odometry_->sensor().T_body_sensor, origin);
  }
  std::unique_ptr<Estimator> clone() const override;
  std::size_t bytes() const override { return odometry_->bytes(); }  // copies share keyframes
  std::vector<Eigen::Vector3d> local_map() const override { return odometry_->local_map(); }
  std::vector<MatchedPoint> matches() const override { return odometry_->matches(); }

 private:
  SlamEstimator(const SlamEstimator& other);

  std::vector<PoseFrame> close_loops(std::vector<PoseFrame> frames);
  void take(const sensors::GnssFix& fix);
  void place_fixes(const lidar::Frame& frame);
  void place(const sensors::GnssFix& fix, const geometry::Pose3& T_odom_lidar);
  void level(const lidar::Frame& frame);
  std::string gravity_note() const;

  SlamGnssOptions gnss_;
  std::string receiver_;         ///< label; empty: no fixes
  std::string unused_receiver_;  ///< label of one whose fixes are not used
  std::string gnss_note_;        ///< why fixes are not used although there are some
  Eigen::Vector3d antenna_lidar_ = Eigen::Vector3d::Zero();
  std::optional<geodesy::LocalTangentPlane> plane_;  ///< at the first fix
  std::deque<sensors::GnssFix> fixes_;               ///< that wait for the frame after them
  std::optional<lidar::Frame> last_frame_;

  std::string imu_;  ///< label
  std::size_t imu_samples_ = 0;
  std::optional<slam::GravityFinder> gravity_;  ///< nothing: up is not looked for

  std::unique_ptr<LidarEstimator> odometry_;
  slam::Slam slam_;
  std::vector<std::string> columns_;
  std::deque<std::shared_ptr<const sensors::LidarScan>> waiting_;  ///< for their frames
};

}  // namespace traverse::pipeline
