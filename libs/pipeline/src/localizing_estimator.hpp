#pragma once

#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "traverse/pipeline/estimator.hpp"
#include "traverse/slam/localizer.hpp"

#include "lidar_estimator.hpp"

namespace traverse::pipeline {

/// The map to follow a recording in.
struct LocalizationOptions {
  std::string map;            ///< keyframes.simplemap of a run
  std::vector<double> start;  ///< x, y, z [m] and yaw [deg] of the body; empty: search everywhere
  slam::LocalizerOptions search;
};
void bind(config::Binder& binder, LocalizationOptions& options);

/// A lidar odometry followed in a given map: frames are told in the map's frame, from the scan on
/// that was found there (those before it then too). When the place is lost, frames wait until it is
/// found again, or are told by odometry from the last known place at the end.
class LocalizingEstimator final : public Estimator {
 public:
  /// \throws files::InputError if the map cannot be read
  LocalizingEstimator(std::unique_ptr<LidarEstimator> odometry, const LocalizationOptions& options,
                      const slam::SlamOptions& checks);

  const std::vector<std::string>& columns() const override { return columns_; }
  std::vector<PoseFrame> process(const sensors::Measurement& measurement) override;
  /// \throws std::runtime_error if no scan was found in the map
  std::vector<PoseFrame> finish() override;
  UsedScan used_scan(const sensors::LidarScan& scan, const PoseFrame& frame,
                     bool with_classes) const override {
    return odometry_->used_scan(scan, frame, with_classes);
  }
  std::string points_are() const override { return odometry_->points_are(); }
  std::vector<Decision> decisions() const override;
  std::vector<SensorUse> sensor_use() const override { return odometry_->sensor_use(); }
  std::vector<HealthReason> troubles() const override { return odometry_->troubles(); }
  std::vector<optimization::FactorUse> factors() const override { return odometry_->factors(); }
  std::unique_ptr<Estimator> clone() const override;
  std::vector<Eigen::Vector3d> local_map() const override { return odometry_->local_map(); }

 private:
  LocalizingEstimator(const LocalizingEstimator& other);

  std::vector<PoseFrame> locate(std::vector<PoseFrame> frames);
  void note(const slam::Localizer::Fix& fix);
  PoseFrame placed(PoseFrame frame, const geometry::Pose3& T_map_odom) const;

  std::unique_ptr<LidarEstimator> odometry_;
  std::string map_file_;
  slam::KeyframeMaker maker_;
  slam::Localizer localizer_;
  std::vector<std::string> columns_;
  std::deque<std::shared_ptr<const sensors::LidarScan>> waiting_;  ///< for their frames
  std::vector<PoseFrame> unplaced_;  ///< by odometry, while the place is not known
  geometry::Pose3 T_map_odom_;       ///< the last known
  bool located_ = false;
  std::size_t frames_ = 0;
  std::vector<std::string> events_;  ///< "found in frame 3", "lost in frame 240 (little in common)"
  std::map<std::string, std::size_t> in_vain_;  ///< scans that were searched for, by verdict
};

}  // namespace traverse::pipeline
