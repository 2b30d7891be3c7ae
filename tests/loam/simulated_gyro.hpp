#pragma once

#include <vector>

#include "traverse/geometry/so3.hpp"
#include "traverse/sensors/imu_sample.hpp"
#include "traverse/simulation/drive.hpp"

namespace traverse::testing {

/// Angular rates of a drive at 100 Hz in the lidar's axes, exact; without accelerations.
inline std::vector<sensors::ImuSample> simulated_gyro(const simulation::Drive& drive,
                                                      double first_s, double last_s) {
  constexpr double kPeriod = 0.01;
  constexpr double kHalfStep = 1e-4;
  std::vector<sensors::ImuSample> samples;
  for (int i = 0; first_s + i * kPeriod <= last_s; ++i) {
    const double t = first_s + i * kPeriod;
    const Eigen::Matrix3d R_before_after =
        drive.pose(t - kHalfStep).rotation.transpose() * drive.pose(t + kHalfStep).rotation;
    sensors::ImuSample sample;
    sample.stamp = geometry::Stamp::from_seconds(t);
    sample.sensor = "imu";
    sample.angular_rate = geometry::log_so3(R_before_after) / (2 * kHalfStep);
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace traverse::testing
