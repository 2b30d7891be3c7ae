#pragma once

#include <vector>

#include "traverse/geometry/so3.hpp"
#include "traverse/sensors/imu_sample.hpp"
#include "traverse/sensors/rig.hpp"
#include "traverse/simulation/drive.hpp"

namespace traverse::testing {

inline constexpr double kGravityOfTests = 9.80665;

/// A lidar that is the body, and an IMU below it whose axes are the lidar's.
struct LidarAndImu {
  sensors::Rig rig;
  Eigen::Vector3d p_lidar_imu{-0.4, 0.1, -1.4};

  LidarAndImu() {
    sensors::MountedSensor lidar;
    lidar.label = "lidar";
    sensors::MountedSensor imu;
    imu.label = "imu";
    imu.kind = sensors::SensorKind::kImu;
    imu.T_body_sensor.translation = p_lidar_imu;
    rig.sensors = {lidar, imu};
  }
};

/// What an IMU without errors but constant biases reads on a moving lidar, at 100 Hz.
/// \param pose  T_map_lidar at a time in seconds, map with z up
template <typename Pose>
std::vector<sensors::ImuSample> simulated_imu(const Pose& pose, const Eigen::Vector3d& p_lidar_imu,
                                              double first_s, double last_s,
                                              const Eigen::Vector3d& gyro_bias,
                                              const Eigen::Vector3d& accelerometer_bias) {
  constexpr double kPeriod = 0.01;
  constexpr double kStep = 1e-3;
  std::vector<sensors::ImuSample> samples;
  for (int i = 0; first_s + i * kPeriod <= last_s; ++i) {
    const double t = first_s + i * kPeriod;
    const Eigen::Matrix3d R = pose(t).rotation;
    const Eigen::Vector3d acceleration =
        (pose(t + kStep) * p_lidar_imu - 2 * (pose(t) * p_lidar_imu) +
         pose(t - kStep) * p_lidar_imu) /
        (kStep * kStep);
    sensors::ImuSample sample;
    sample.stamp = geometry::Stamp::from_seconds(t);
    sample.sensor = "imu";
    sample.angular_rate =
        geometry::log_so3(pose(t - kStep).rotation.transpose() * pose(t + kStep).rotation) /
            (2 * kStep) +
        gyro_bias;
    sample.specific_force =
        R.transpose() * (acceleration + Eigen::Vector3d(0, 0, kGravityOfTests)) +
        accelerometer_bias;
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace traverse::testing
