#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/geometry/pose3.hpp"
#include "traverse/sensors/rig.hpp"

namespace traverse::dataset {

class Statements;

/// Where sensors are on the vehicle, where a recording does not say it itself.
struct VehicleStatements {
  std::vector<double> imu_position_m;  ///< in the body; [3] or empty, as all here
  std::vector<double> imu_roll_pitch_yaw_deg;
  std::vector<double> gnss_position_m;
  double gnss_heading_offset_deg = 0;
  std::vector<double> wheels_position_m;
  double left_m_per_pulse = 0;
  double right_m_per_pulse = 0;
};
void bind(config::Binder& binder, VehicleStatements& vehicle);

/// What states the mounting of the first IMU, receiver and wheels of `rig`.
VehicleStatements vehicle_statements_of(const sensors::Rig& rig);

/// The rotation about x, then y, then z that three numbers in degrees state; the identity for none.
/// \throws files::InputError for a vector that has not three numbers
Eigen::Matrix3d stated_rotation(const Statements& statements, const std::string& key,
                                const std::vector<double>& roll_pitch_yaw_deg);

/// Gives a sensor of the rig what is stated about its kind; what is not stated stays.
/// \throws files::InputError for a vector that has not three numbers
void apply_vehicle(const Statements& statements, sensors::MountedSensor& sensor);

}  // namespace traverse::dataset
