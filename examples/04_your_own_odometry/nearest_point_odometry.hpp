#pragma once

#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/geometry/voxel.hpp"
#include "traverse/lidar/odometry.hpp"

/// Settings, each with its value by default; bind() gives them their keys, ranges and meanings,
/// from which presets are read and checked, and the report lists them.
struct NearestPointOptions {
  double voxel_m = 1.0;
  double radius_m = 100;
  int iterations = 30;
};
void bind(traverse::config::Binder& binder, NearestPointOptions& options);

/// An odometry to begin with: each scan, thinned and deskewed by the predicted motion, is brought
/// onto the nearest points of a map with one point a voxel, by closed-form alignment again and
/// again.
class NearestPointOdometry final : public traverse::lidar::Odometry {
 public:
  NearestPointOdometry(const NearestPointOptions& options,
                       const traverse::sensors::LidarProfile& profile, bool motion_compensated);

  std::vector<traverse::lidar::Frame> process(const traverse::sensors::LidarScan& scan) override;
  std::vector<traverse::lidar::Frame> finish() override { return {}; }  // none is held back
  const std::string& deskew_note() const override { return deskew_note_; }
  traverse::lidar::CorrectedScan used_scan(const traverse::sensors::LidarScan& scan,
                                           const traverse::geometry::Twist& velocity,
                                           bool with_classes) const override;
  std::unique_ptr<Odometry> clone() const override {
    return std::make_unique<NearestPointOdometry>(*this);
  }
  std::size_t bytes() const override { return map_.size() * 48; }
  std::vector<Eigen::Vector3d> local_map() const override;

 private:
  using Points = std::vector<Eigen::Vector3d>;

  Points thinned(const traverse::lidar::CorrectedScan& scan) const;
  const Eigen::Vector3d* nearest(const Eigen::Vector3d& p_map) const;
  /// Moves T_map_lidar_ from the prediction onto the map.
  void align(const Points& points_lidar, traverse::lidar::RegistrationHealth& health);
  void insert(const Points& points_lidar);

  NearestPointOptions options_;
  traverse::sensors::LidarProfile profile_;
  std::string deskew_note_;
  std::unordered_map<std::uint64_t, Eigen::Vector3d, traverse::geometry::VoxelHash> map_;
  std::size_t frames_ = 0;
  traverse::geometry::Stamp last_stamp_;
  traverse::geometry::Pose3 T_map_lidar_;
  traverse::geometry::Twist velocity_ =
      traverse::geometry::Twist::Zero();  // of the lidar, a second
};
