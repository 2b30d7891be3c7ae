#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/pipeline/estimator.hpp"
#include "traverse/sensors/rig.hpp"

namespace traverse::replay {

/// For recordings without a 3-D lidar: the path that the recording itself tells, by its wheel
/// odometry, else by its satellite fixes, one frame a measurement of the frame sensor. The map
/// frame is the body frame at the first; with GNSS alone its axes are east, north and up.
class PathEstimator final : public pipeline::Estimator {
 public:
  explicit PathEstimator(std::string frame_sensor) : frame_sensor_(std::move(frame_sensor)) {}

  const std::vector<std::string>& columns() const override;
  std::vector<pipeline::PoseFrame> process(const sensors::Measurement& measurement) override;
  std::vector<pipeline::PoseFrame> finish() override { return {}; }
  pipeline::UsedScan used_scan(const sensors::LidarScan& scan, const pipeline::PoseFrame& frame,
                               bool with_classes) const override;
  std::string points_are() const override { return "as recorded"; }
  std::vector<pipeline::Decision> decisions() const override;
  std::unique_ptr<pipeline::Estimator> clone() const override {
    return std::make_unique<PathEstimator>(*this);
  }

 private:
  void observe(const sensors::WheelOdometry& odometry);
  void observe(const sensors::GnssFix& fix);
  std::optional<geometry::Pose3> present() const;

  std::string frame_sensor_;
  std::optional<geometry::Pose3> T_odom_first_;
  std::optional<geometry::Pose3> T_odom_body_;
  std::optional<geometry::Pose3> T_ecef_local_;  // local: east, north, up at the first fix
  std::optional<Eigen::Vector3d> p_local_;
};

}  // namespace traverse::replay
