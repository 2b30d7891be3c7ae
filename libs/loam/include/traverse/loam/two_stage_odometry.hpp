#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/lidar/frame.hpp"
#include "traverse/lidar/held_back.hpp"
#include "traverse/lidar/odometry.hpp"
#include "traverse/loam/imu_prediction.hpp"
#include "traverse/loam/scan_to_map.hpp"
#include "traverse/loam/scan_to_scan.hpp"
#include "traverse/loam/speed_search.hpp"

namespace traverse::loam {

struct TwoStageOdometryOptions {
  bool deskew =
      true;  ///< undo the motion within a sweep, unless the recording did or gives no times
  FeatureOptions features;
  ThinningOptions thinning;    ///< of the second stage
  ScanToScanOptions odometry;  ///< the first stage
  MapOptions map;
  AssociationOptions association;  ///< of the second stage
  SolverOptions solver;            ///< of both
  int registration_steps = 2;      ///< associations in the map, with a solve each; 0: the first
                                   ///< stage alone
  ImuOptions imu;
  SpeedSearchOptions start;
  int threads = 1;  ///< of association; the result does not depend on it
};
void bind(config::Binder& binder, TwoStageOdometryOptions& options);

/// LOAM (Zhang and Singh, "LOAM: Lidar odometry and mapping in real-time", RSS 2014): the first
/// stage follows the lidar from scan to scan, the second registers each scan in a local map and
/// corrects what the first has drifted,
///     T_map_lidar = T_map_odom T_odom_lidar,
/// where T_map_odom is kept between scans. Presets: A-LOAM and LOAM. What published codes get wrong
/// is mended:
///  * the sweep's motion is undone in both stages, and the last sweep is deskewed by its motion;
///  * scan lines come from the data, features cover every point, occluded and grazing points are
///    not picked; a plane's three points must make a triangle; the map's planes and lines are
///    principal components of neighbours from more than one scan line;
///  * the motion model knows the true time between scans; the first speed is searched for;
///  * degenerate directions keep their prediction in both stages: V diag(mask) V' of a scaled
///    information matrix at every solve (Observability);
///  * every scan is mapped. The map is LocalMap, voxels within a radius, in place of A-LOAM's cubes
///    of 50 m, whose purpose it has: to bound what is searched.
///
/// Unusual scans: without features the prediction stands; a stamp that is not later than the one
/// before (or by less than a tenth of a sweep) registers without a motion model, and the speed
/// stays; points that are not finite or on a ring beyond the profile's are counted and left out.
class TwoStageOdometry final : public lidar::Odometry {
 public:
  /// \param profile of the sensor  \param motion_compensated the scans need no deskew
  TwoStageOdometry(const TwoStageOdometryOptions& options, const sensors::LidarProfile& profile,
                   bool motion_compensated);

  std::vector<lidar::Frame> process(const sensors::LidarScan& scan) override;
  std::vector<lidar::Frame> finish() override;
  void observe(const sensors::ImuSample& sample_lidar) override;
  bool uses_imu() const override { return imu_.is_used(); }
  const std::string& deskew_note() const override { return deskew_note_; }
  lidar::CorrectedScan used_scan(const sensors::LidarScan& scan, const geometry::Twist& velocity,
                                 bool with_classes) const override;
  const std::vector<std::string>& further_columns() const override;
  std::unique_ptr<lidar::Odometry> clone() const override {
    return std::make_unique<TwoStageOdometry>(*this);
  }  /// Copies share the points of the last sweep.
  std::size_t bytes() const override { return map_.bytes() + matches_.bytes(); }

  /// Map and matches of the second stage; empty without it.
  std::vector<Eigen::Vector3d> local_map() const override;
  std::vector<lidar::MatchedPoint> matches() const override;

  /// Those of both stages: swept ones where the first moves each point by its share.
  std::vector<optimization::FactorUse> factors() const override;

  /// What the second stage has corrected so far.
  const geometry::Pose3& T_map_odom() const { return T_map_odom_; }

 private:
  struct Prepared {
    ScanFeatures features;
    SweepFeatures sweep;
    lidar::StageTimes ms;
  };

  std::vector<lidar::Frame> advance_all(std::vector<Prepared> scans);
  geometry::Twist initial_velocity(std::vector<Prepared>& first) const;
  lidar::Frame advance(const Prepared& scan);
  MotionPrediction predict(geometry::Stamp stamp) const;

  TwoStageOdometryOptions options_;
  sensors::LidarProfile profile_;
  std::string deskew_note_;
  ScanToMapOptions scan_to_map_;
  ScanToScan scan_to_scan_;
  ScanToMap map_;
  ImuPrediction imu_;

  lidar::HeldBack<Prepared> held_back_;

  std::size_t frames_ = 0;
  geometry::Stamp last_stamp_;
  geometry::Pose3 T_odom_lidar_;
  geometry::Pose3 T_map_odom_;
  geometry::Pose3 T_map_last_;
  geometry::Twist velocity_ = geometry::Twist::Zero();  // between the last two frames
  Matches matches_;                                     // of the last frame, in the map
};

}  // namespace traverse::loam
