#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"
#include "traverse/inertial/navigation.hpp"
#include "traverse/pipeline/estimator.hpp"

namespace traverse::pipeline {

/// Navigation on the first IMU, GNSS receiver and wheels of the rig. The map is east, north, up at
/// the first fix; without fixes it is level and begins with the body's heading.
class NavigationEstimator final : public Estimator {
 public:
  /// \throws std::runtime_error if the rig has no IMU.
  NavigationEstimator(const inertial::NavigationOptions& options,
                      const dataset::RecordingInfo& recording);

  const std::vector<std::string>& columns() const override;
  bool depends_on(sensors::SensorKind kind) const override;
  std::vector<PoseFrame> process(const sensors::Measurement& measurement) override;
  /// \throws std::runtime_error saying why navigation never began.
  std::vector<PoseFrame> finish() override;
  UsedScan used_scan(const sensors::LidarScan& scan, const PoseFrame& frame,
                     bool with_classes) const override;
  std::string points_are() const override { return "none used"; }
  std::vector<Decision> decisions() const override;
  std::vector<SensorUse> sensor_use() const override;
  std::optional<Eigen::Vector3d> north_map() const override;
  std::vector<optimization::FactorUse> factors() const override;
  std::optional<geodesy::Geodetic> map_origin() const override {
    const auto& plane = navigation_.plane();
    return plane ? std::optional(plane->origin()) : std::nullopt;
  }
  std::unique_ptr<Estimator> clone() const override {
    return std::make_unique<NavigationEstimator>(*this);
  }

 private:
  /// Readings that wait for the frame that they are in.
  struct Readings {
    std::deque<geometry::Stamp> waiting;
    std::size_t used = 0;
    std::size_t rejected = 0;

    /// Those up to `stamp` are through.
    void finish(geometry::Stamp stamp, std::size_t Readings::*count);
  };

  void count(const inertial::NavFrame& frame);
  std::string events_about(const std::string& word) const;
  std::optional<double> roughness(const inertial::NavFrame& frame);
  std::vector<PoseFrame> to_body(const std::vector<inertial::NavFrame>& frames);

  inertial::NavigationOptions options_;
  std::string recording_;
  std::string imu_;
  std::string gnss_;  ///< label; empty: none
  std::string wheels_;
  Eigen::Matrix3d R_body_imu_;
  geometry::Pose3 T_nav_body_;      ///< the filter's body has the rig's axes, at the IMU's place
  Eigen::Vector3d p_antenna_told_;  ///< of the antenna from the body whose poses are told [m]
  inertial::Navigation navigation_;
  std::deque<inertial::NavState> at_fixes_;  ///< the last three
  Readings imu_readings_, fixes_, wheel_readings_;
  std::size_t frames_ = 0;
  double milliseconds_ = 0;  ///< since the last frame
};

}  // namespace traverse::pipeline
