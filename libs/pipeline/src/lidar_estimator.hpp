#pragma once

#include <memory>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"
#include "traverse/lidar/corrected_scan.hpp"
#include "traverse/lidar/odometry.hpp"
#include "traverse/pipeline/estimator.hpp"

namespace traverse::pipeline {

/// Lidar odometry on the first lidar of the rig; the map frame is the body frame of the first scan.
class LidarEstimator final : public Estimator {
 public:
  /// \throws std::runtime_error if the rig has no lidar.
  LidarEstimator(const lidar::OdometryOptions& options, const dataset::RecordingInfo& recording);

  const std::vector<std::string>& columns() const override;
  std::vector<PoseFrame> process(const sensors::Measurement& measurement) override;
  std::vector<PoseFrame> finish() override;
  UsedScan used_scan(const sensors::LidarScan& scan, const PoseFrame& frame,
                     bool with_classes) const override;
  std::string points_are() const override;
  std::vector<Decision> decisions() const override;

 private:
  std::vector<PoseFrame> to_body(const std::vector<lidar::Frame>& frames) const;

  lidar::OdometryOptions options_;
  sensors::MountedSensor sensor_;
  lidar::LidarOdometry odometry_;
};

}  // namespace traverse::pipeline
