#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "traverse/lidar/held_back.hpp"
#include "traverse/lidar/odometry.hpp"
#include "traverse/parallel/workers.hpp"
#include "traverse/voxel_map/lidar_uncertainty.hpp"
#include "traverse/voxel_map/start_search.hpp"
#include "traverse/voxel_map/sweep_sampler.hpp"

namespace traverse::voxel_map {

struct VoxelMapOdometryOptions {
  bool deskew = true;  ///< undo the motion within a sweep, unless the recording did
  SamplingOptions sampling;
  VoxelMapOptions map;
  AlignmentOptions alignment;
  StartSearchOptions start;
  /// Frames carry the covariance of their pose. Of a lidar alone it is far too small: what its
  /// first scans agree on is wrong together (docs/mathematics-fusion.md).
  bool covariance = false;
  int first_frames = 5;  ///< registered with more effort: their predictions are worse
  int threads = 1;       ///< the result does not depend on it
};
void bind(config::Binder& binder, VoxelMapOdometryOptions& options);

/// The fast and accurate odometry: planar points against the planes, ends of surfaces against the
/// lines of a voxel map.
///
///     for each scan:  sample planar points and edge points along the rings
///                     predict the pose by the last velocity
///                     align: associate by cell, minimise the robust cost, deskew by the result
///                     insert the sample at the pose found
///
/// What is estimated is the pose in the middle of the sweep, wherever its stamp is; a frame's pose
/// is that one moved on to the stamp by the velocity. With the pose before it known, the motion
/// within a sweep follows from this pose. One at the sweep's end would move the mean point only
/// half as far as itself, so that its error would be twice theirs, and the next one the other way.
///
/// What happens to odd input: points that are not finite, at the origin, out of range or of a ring
/// beyond the profile's are left out and counted. A scan with too few matches keeps the prediction,
/// says so in its health and does not enter the map, unless there is no map yet. A scan stamped no
/// later than the one before counts as taken one sweep later. Scans without rings are cut into rows
/// by elevation.
class VoxelMapOdometry final : public lidar::Odometry {
 public:
  /// \param profile of the sensor  \param motion_compensated the scans need no deskew
  VoxelMapOdometry(const VoxelMapOdometryOptions& options, const sensors::LidarProfile& profile,
                   bool motion_compensated);

  std::vector<lidar::Frame> process(const sensors::LidarScan& scan) override;
  /// The same of a scan that sampler() has sampled, for odometry that is built on this one.
  std::vector<lidar::Frame> process(SweepSample sample);
  SweepSampler& sampler() { return sampler_; }
  /// Goes on from what another odometry has found, in its map.
  struct Known {
    std::size_t frames = 0;
    geometry::Stamp stamp;  ///< of the last scan
    double middle_s = 0;    ///< of its sweep, after that
    geometry::Pose3 T_map_middle;
    geometry::Twist velocity = geometry::Twist::Zero();  ///< body twist a second
    PoseUncertainty uncertainty;
  };
  void go_on(const VoxelMap& map, const Known& last);
  std::vector<lidar::Frame> finish() override;
  const std::string& deskew_note() const override { return deskew_note_; }
  bool tells_covariance() const override { return options_.covariance; }

  /// Classes: kSharp an edge point, kFlat a registered planar point, kLessFlat another planar
  /// point, kNone a point that was not sampled or is not planar.
  lidar::CorrectedScan used_scan(const sensors::LidarScan& scan, const geometry::Twist& velocity,
                                 bool with_classes) const override;

  std::unique_ptr<lidar::Odometry> clone() const override {
    return std::make_unique<VoxelMapOdometry>(*this);
  }
  std::size_t bytes() const override { return map_.bytes() + matches_.bytes(); }

  /// The middle of the points of each cell that has a plane or a line.
  std::vector<Eigen::Vector3d> local_map() const override;
  std::vector<lidar::MatchedPoint> matches() const override;
  /// The rows of row_factor_kinds(), of which the cost is the sum.
  std::vector<optimization::FactorUse> factors() const override;

  const VoxelMap& map() const { return map_; }
  /// Of the last frame's pose in the middle of its sweep.
  const PoseUncertainty& uncertainty() const { return uncertainty_.pose(); }

 private:
  std::vector<lidar::Frame> advance_all(const std::vector<SweepSample>& scans);
  lidar::Frame advance(const SweepSample& sample, double start_ms);
  /// Registers the first scan, too, with a map: of those that were held back behind it. All poses
  /// are told from it, and its own planes, by which the others were registered, are those of a
  /// single scan. The map is built once more, with the first scan at the origin of it.
  void settle(const std::vector<SweepSample>& scans, std::vector<lidar::Frame>& frames);

  VoxelMapOdometryOptions options_;
  sensors::LidarProfile profile_;
  std::string deskew_note_;
  std::shared_ptr<parallel::Workers> workers_;  ///< copies share the threads, which hold no state
  VoxelMap map_;

  lidar::HeldBack<SweepSample> held_back_;
  SweepSampler sampler_;

  std::size_t frames_ = 0;
  geometry::Stamp last_stamp_;
  double last_middle_s_ = 0;                            // after that stamp: the moment of the pose
  geometry::Pose3 T_map_last_;                          // in the middle of the last sweep
  geometry::Twist velocity_ = geometry::Twist::Zero();  // at the last frame
  LidarUncertainty uncertainty_;
  ScanMatches matches_;  // of the last frame; kept for its memory too
};

}  // namespace traverse::voxel_map
