#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"
#include "traverse/lidar/odometry.hpp"
#include "traverse/pipeline/estimator.hpp"

namespace traverse::pipeline {

/// Lidar odometry on the first lidar of the rig; the map frame is the body frame of the first scan.
class LidarEstimator final : public Estimator {
 public:
  /// Makes the algorithm for a sensor; the flag says that scans are motion-compensated already.
  using MakeOdometry = std::function<std::unique_ptr<lidar::Odometry>(
      const sensors::LidarProfile& profile, bool motion_compensated)>;

  /// \throws std::runtime_error if the rig has no lidar.
  LidarEstimator(const MakeOdometry& make, const dataset::RecordingInfo& recording);

  const std::vector<std::string>& columns() const override;
  std::vector<PoseFrame> process(const sensors::Measurement& measurement) override;
  std::vector<PoseFrame> finish() override;
  UsedScan used_scan(const sensors::LidarScan& scan, const PoseFrame& frame,
                     bool with_classes) const override;
  std::string points_are() const override;
  std::vector<Decision> decisions() const override;
  std::vector<SensorUse> sensor_use() const override;
  std::vector<HealthReason> troubles() const override;
  std::vector<optimization::FactorUse> factors() const override { return odometry_->factors(); }
  std::unique_ptr<Estimator> clone() const override;
  std::size_t bytes() const override { return odometry_->bytes(); }
  std::vector<Eigen::Vector3d> local_map() const override;
  std::vector<MatchedPoint> matches() const override;

  /// What process() or finish() told last, as the lidar saw it.
  const std::vector<lidar::Frame>& latest() const { return latest_; }
  const lidar::Odometry& odometry() const { return *odometry_; }
  const sensors::MountedSensor& sensor() const { return sensor_; }
  std::unique_ptr<LidarEstimator> copy() const;

 private:
  LidarEstimator(const LidarEstimator& other);

  std::vector<PoseFrame> to_body(std::vector<lidar::Frame> frames);
  void observe(const sensors::ImuSample& sample);

  sensors::MountedSensor sensor_;
  geometry::Pose3 T_lidar_imu_;
  std::string imu_;     ///< label of the first IMU of the rig; empty: none
  std::string wheels_;  ///< of the first wheels
  std::unique_ptr<lidar::Odometry> odometry_;
  std::vector<std::string> columns_;
  std::vector<lidar::Frame> latest_;
  std::size_t frames_ = 0;
  std::size_t not_registered_ = 0;
  std::size_t imu_samples_ = 0;
  std::size_t wheel_readings_ = 0;
  bool has_times_;  ///< of points, or the scans need none
  double path_m_ = 0;
  Eigen::Vector3d last_position_ = Eigen::Vector3d::Zero();
};

}  // namespace traverse::pipeline
