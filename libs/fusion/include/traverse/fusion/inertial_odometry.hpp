#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/inertial/inertial_chain.hpp"
#include "traverse/inertial/stand_still.hpp"
#include "traverse/lidar/odometry.hpp"
#include "traverse/voxel_map/voxel_map_odometry.hpp"

namespace traverse::fusion {

/// How fusion begins, and when it does not.
struct StartOptions {
  inertial::StandStillOptions stand_still;
  double moving_s = 2;              ///< of poses by the lidar alone, in motion
  double gravity = 9.80665;         ///< m/s^2
  double accelerometer_bias = 0.1;  ///< standard deviation at the start, m/s^2
  double most_gyro_bias = 0.2;      ///< rad/s; more is no bias
  double most_gravity_error = 1;    ///< m/s^2, of the length that the start in motion finds
  double longest_gap_s = 0.15;      ///< of the IMU's readings
  /// What an IMU is not believed beyond: biases that no unit has stand for wrong axes or units.
  double most_accelerometer_bias = 0.6;  ///< m/s^2
  /// Chi-square by degrees of freedom of the matches against the prediction, over forty scans.
  double most_disagreement = 10;
};
void bind(config::Binder& binder, StartOptions& options);

struct InertialOdometryOptions {
  InertialOdometryOptions();

  voxel_map::VoxelMapOdometryOptions lidar;  ///< its settings are at the top of a preset
  inertial::ImuNoise imu;
  inertial::WindowOptions window;
  inertial::WheelOptions wheels;
  StartOptions start;
  /// Of the planes' `min_width_m` where there is an IMU: points of one ring scatter along the rays,
  /// and a plane through them would hold the attitude that the lidar had.
  double min_plane_width_m = 0.08;
  double information_share = 0.1;  ///< of the matches' information that is new
  int threads = 1;                 ///< the result does not depend on it
};
void bind(config::Binder& binder, InertialOdometryOptions& options);

/// Lidar, IMU and, where there are any, wheels in one estimate: the voxel map of the default
/// odometry, and the chain of navigation.
///
///     for each scan:  the state in the middle of its sweep, as the IMU leads to it (append)
///                     rounds: deskew by the IMU at the present state, associate, condense the
///                             matches to their normal equations, one step of the state under them
///                             and the chain's prediction
///                     the last round's normal equations join the chain, which is solved
///                     insert the sample, deskewed by the state that is found
///
/// Until gravity, velocity and the gyro's bias are known (find_start) poses are those of
/// VoxelMapOdometry, bit for bit (with an IMU, on planes of min_plane_width_m); so they are for
/// good without an IMU. Where the matches do not tell a direction (a tunnel's axis), their
/// information on it is left out, and the IMU and the wheels carry it. Matches err alike from scan
/// to scan, because they are on the same surfaces: of their information `information_share` counts.
///
/// An IMU that contradicts the lidar (biases that no unit has, or predictions that are off by many
/// times what they say) is given up for good: the lidar alone goes on, and the run says so.
///
/// The map's frame is the first scan's, with gravity wherever it is found there; it is not
/// estimated further. A frame is told when the IMU has covered its sweep, at the next scan at
/// latest. In a gap of the IMU of more than longest_gap_s constant velocity stands in, with little
/// weight.
class InertialOdometry final : public lidar::Odometry {
 public:
  InertialOdometry(const InertialOdometryOptions& options, const sensors::LidarProfile& profile,
                   bool motion_compensated);
  InertialOdometry(const InertialOdometry& other);
  ~InertialOdometry() override;

  void mount(const sensors::Rig& rig, const sensors::MountedSensor& lidar) override;
  void observe(const sensors::ImuSample& sample_lidar) override;
  bool uses_imu() const override;
  void observe_wheels(const sensors::WheelOdometry& reading) override;
  bool uses_wheels() const override;

  std::vector<lidar::Frame> process(const sensors::LidarScan& scan) override;
  std::vector<lidar::Frame> finish() override;
  const std::string& deskew_note() const override;
  std::vector<lidar::Note> notes() const override;
  bool tells_covariance() const override { return true; }
  const std::vector<std::string>& further_columns() const override;

  /// Of the latest sweeps deskewed as the IMU says; of others, and before fusion, by `velocity`.
  lidar::CorrectedScan used_scan(const sensors::LidarScan& scan, const geometry::Twist& velocity,
                                 bool with_classes) const override;

  std::unique_ptr<lidar::Odometry> clone() const override {
    return std::make_unique<InertialOdometry>(*this);
  }
  std::size_t bytes() const override;
  std::vector<Eigen::Vector3d> local_map() const override;
  std::vector<lidar::MatchedPoint> matches() const override;
  std::vector<optimization::FactorUse> factors() const override;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace traverse::fusion
