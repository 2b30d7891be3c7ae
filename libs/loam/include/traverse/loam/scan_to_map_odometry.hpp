#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/lidar/frame.hpp"
#include "traverse/lidar/held_back.hpp"
#include "traverse/lidar/odometry.hpp"
#include "traverse/loam/scan_to_map.hpp"
#include "traverse/loam/speed_search.hpp"

namespace traverse::loam {

struct ScanToMapOdometryOptions {
  bool deskew =
      true;  ///< undo the motion within a sweep, unless the recording did or gives no times
  FeatureOptions features;
  ThinningOptions thinning;
  MapOptions map;
  AssociationOptions association;
  SolverOptions solver;
  int registration_steps = 2;         ///< associations with a solve each, of a frame
  int first_registration_steps = 12;  ///< of the second frame; one fewer each frame until the above
  SpeedSearchOptions start;
  int threads = 1;  ///< of association; the result does not depend on it
};
void bind(config::Binder& binder, ScanToMapOdometryOptions& options);

/// Lidar odometry that registers each scan's edge and planar points in a local map: F-LOAM (Wang,
/// Wang, Chen and Xie, "F-LOAM: Fast lidar odometry and mapping", IROS 2021) with its faults
/// mended:
///  * sectors cover every point; occluded and grazing points are rejected as in LOAM;
///  * planes by principal components, lines guarded at zero distance;
///  * the motion model knows the true time between scans, and the first speed is searched for;
///  * degenerate directions keep their prediction;
///  * deskew in two stages as published: by the predicted motion for registration, by the
///    estimated motion for the map.
class ScanToMapOdometry final : public lidar::Odometry {
 public:
  /// \param profile of the sensor  \param motion_compensated the scans need no deskew
  ScanToMapOdometry(const ScanToMapOdometryOptions& options, const sensors::LidarProfile& profile,
                    bool motion_compensated);

  std::vector<lidar::Frame> process(const sensors::LidarScan& scan) override;
  std::vector<lidar::Frame> finish() override;
  const std::string& deskew_note() const override { return deskew_note_; }
  std::vector<optimization::FactorUse> factors() const override;
  lidar::CorrectedScan used_scan(const sensors::LidarScan& scan, const geometry::Twist& velocity,
                                 bool with_classes) const override;
  std::unique_ptr<lidar::Odometry> clone() const override {
    return std::make_unique<ScanToMapOdometry>(*this);
  }
  std::size_t bytes() const override { return map_.bytes() + matches_.bytes(); }
  std::vector<Eigen::Vector3d> local_map() const override { return map_.points(); }
  std::vector<lidar::MatchedPoint> matches() const override;

  const ScanToMap& map() const { return map_; }

 private:
  struct Prepared {
    ScanFeatures features;
    lidar::StageTimes ms;
  };

  std::vector<lidar::Frame> advance_all(std::vector<Prepared> scans);
  lidar::Frame advance(const Prepared& scan);
  int steps_of_this_frame() const;

  ScanToMapOdometryOptions options_;
  sensors::LidarProfile profile_;
  std::string deskew_note_;
  ScanToMapOptions scan_to_map_;
  ScanToMap map_;
  lidar::HeldBack<Prepared> held_back_;

  std::size_t frames_ = 0;
  geometry::Stamp last_stamp_;
  geometry::Pose3 T_map_last_;
  geometry::Twist velocity_ = geometry::Twist::Zero();  // at the last frame
  Matches matches_;                                     // of the last frame
};

}  // namespace traverse::loam
