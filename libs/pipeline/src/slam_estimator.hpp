#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "traverse/pipeline/estimator.hpp"
#include "traverse/slam/slam.hpp"

#include "lidar_estimator.hpp"

namespace traverse::pipeline {

/// A lidar odometry and the loops that are closed over it. The frames it tells are odometry's, with
/// two more columns in the health record and the time that keyframes and loops took;
/// slam_map() corrects them.
class SlamEstimator final : public Estimator {
 public:
  SlamEstimator(std::unique_ptr<LidarEstimator> odometry, const slam::SlamOptions& options);

  const std::vector<std::string>& columns() const override { return columns_; }
  std::vector<PoseFrame> process(const sensors::Measurement& measurement) override;
  std::vector<PoseFrame> finish() override;
  UsedScan used_scan(const sensors::LidarScan& scan, const PoseFrame& frame,
                     bool with_classes) const override {
    return odometry_->used_scan(scan, frame, with_classes);
  }
  std::string points_are() const override { return odometry_->points_are(); }
  std::vector<Decision> decisions() const override;
  std::vector<optimization::FactorUse> factors() const override;
  std::optional<SlamMap> slam_map() const override {
    return SlamMap(slam_, odometry_->sensor().T_body_sensor);
  }
  std::unique_ptr<Estimator> clone() const override;
  std::vector<Eigen::Vector3d> local_map() const override { return odometry_->local_map(); }
  std::vector<MatchedPoint> matches() const override { return odometry_->matches(); }

 private:
  SlamEstimator(const SlamEstimator& other);

  std::vector<PoseFrame> close_loops(std::vector<PoseFrame> frames);

  std::unique_ptr<LidarEstimator> odometry_;
  slam::Slam slam_;
  std::vector<std::string> columns_;
  std::deque<std::shared_ptr<const sensors::LidarScan>> waiting_;  ///< for their frames
};

}  // namespace traverse::pipeline
