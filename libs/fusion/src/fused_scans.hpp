#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "traverse/fusion/inertial_odometry.hpp"
#include "traverse/parallel/workers.hpp"
#include "traverse/voxel_map/pose_uncertainty.hpp"
#include "traverse/voxel_map/scan_information.hpp"

#include "imu_readings.hpp"
#include "inertial_start.hpp"
#include "sweep_path.hpp"

namespace traverse::fusion {

/// Where the lidar is on the IMU, and what else there is.
struct FusedMounts {
  Eigen::Vector3d p_lidar_body = Eigen::Vector3d::Zero();  ///< in the lidar's axes [m]
  std::optional<inertial::ChainWheels> wheels;
};

/// The estimate of InertialOdometry from its first state on.
class FusedScans {
 public:
  /// \param map  what the lidar alone has mapped  \param known  how far its last pose may be off
  /// \param deskews  whether times within a sweep
  /// count \param frames  that were told before
  FusedScans(const InertialOdometryOptions& options, const FusedMounts& mounts,
             const FirstState& first, voxel_map::VoxelMap map,
             const voxel_map::PoseUncertainty& known, bool deskews, double sweep_s,
             std::size_t frames, std::shared_ptr<parallel::Workers> workers);

  /// \param wheels  readings up to the middle of the sweep that were not given yet
  lidar::Frame add(const voxel_map::SweepSample& sample, const ImuReadings& imu,
                   std::span<const sensors::WheelOdometry> wheels);

  const voxel_map::VoxelMap& map() const { return map_; }
  const inertial::InertialChain& chain() const { return chain_; }
  std::vector<lidar::MatchedPoint> matches() const;
  const std::map<std::string, std::size_t>& events() const { return events_; }
  std::size_t bytes() const;

  /// Of the last scan that was registered: chi-square of where its matches have the pose against
  /// the prediction, by its degrees of freedom; 1 where both err as they are taken to.
  double innovation() const { return innovation_; }
  /// The same over the last forty scans.
  double disagreement() const { return disagreement_; }
  /// Of lidar_in_the_middle().
  const voxel_map::PoseUncertainty& uncertainty() const { return uncertainty_; }
  const geometry::Pose3& lidar_in_the_middle() const { return T_map_last_; }

  /// How the lidar went in one of the latest sweeps, and when its stamp was after the middle.
  struct Swept {
    geometry::Stamp stamp;
    double stamp_s = 0;
    SweepPath path;
  };
  const Swept* sweep_of(geometry::Stamp stamp) const;

 private:
  /// The matches at a pose, condensed: (rotation on the right, position in the map).
  struct Condensed {
    geometry::Pose3 T_map_lidar;  ///< where
    lidar::Matrix6 H;
    lidar::Vector6 g;
  };

  std::vector<sensors::ImuSample> readings_between(geometry::Stamp from, geometry::Stamp to,
                                                   const ImuReadings& imu);
  geometry::Pose3 lidar_pose(const inertial::NavState& x) const;
  SweepPath path_at(const inertial::NavState& x) const;
  void deskew(const voxel_map::SweepSample& sample, const SweepPath& path);
  std::optional<Condensed> condense(const geometry::Pose3& T_map_lidar, double gate_m,
                                    double scale_m, lidar::Frame& frame);
  std::optional<Condensed> register_scan(const voxel_map::SweepSample& sample, lidar::Frame& frame);
  lidar::Matrix6 lidar_by_body(const inertial::NavState& x) const;
  lidar::Matrix6 lidar_twist_by_body(const inertial::NavState& x) const;
  lidar::Matrix6 lidar_covariance() const;
  void note_uncertainty(const geometry::Pose3& T_map_before,
                        const lidar::Matrix6& covariance_before, const lidar::Matrix6& prediction,
                        const lidar::Frame& frame);
  void note_innovation(const Condensed& found, const lidar::Vector6& least);
  bool is_new_view() const;
  void insert(const voxel_map::SweepSample& sample, lidar::Frame& frame);

  InertialOdometryOptions options_;
  FusedMounts mounts_;
  bool deskews_;
  double sweep_s_;
  std::shared_ptr<parallel::Workers> workers_;
  inertial::InertialChain chain_;
  voxel_map::VoxelMap map_;
  std::size_t frames_;
  std::map<std::string, std::size_t> events_;
  std::deque<Swept> swept_;
  voxel_map::PoseUncertainty uncertainty_;
  double innovation_ = 0;
  double disagreement_ = 0;
  Eigen::Vector3d turning_ = Eigen::Vector3d::Zero();  ///< between the last states, body [rad/s]

  // Of the present sweep; kept for their memory.
  lidar::Vector6 shares_ = lidar::Vector6::Ones();  ///< of the information along its directions
  std::vector<sensors::ImuSample> sweep_readings_;
  double first_s_ = 0;
  double last_s_ = 0;
  voxel_map::SweepSample deskewed_;
  voxel_map::MovedSample moved_;
  voxel_map::ScanMatches matches_;
  geometry::Pose3 T_map_last_;
  std::optional<geometry::Pose3> T_map_inserted_;  ///< of the last scan that entered the map
};

}  // namespace traverse::fusion
