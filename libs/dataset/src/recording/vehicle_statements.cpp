#include "recording/vehicle_statements.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/so3.hpp"

#include "recording/statements.hpp"

namespace traverse::dataset {

using config::Binder;
using config::Range;
using sensors::MountedSensor;
using sensors::SensorKind;

namespace {

Eigen::Vector3d vector_of(const Statements& statements, const std::string& key,
                          const std::vector<double>& values) {
  if (values.size() != 3) {
    throw statements.error(key, "three numbers", fmt::format("{}", values.size()));
  }
  return {values[0], values[1], values[2]};
}

void place(const Statements& statements, const std::string& key, const std::vector<double>& values,
           MountedSensor& sensor) {
  if (!statements.states(key)) return;
  sensor.T_body_sensor.translation = vector_of(statements, key, values);
}

}  // namespace

void bind(Binder& b, VehicleStatements& v) {
  b.group("imu", "of the IMU", [&](Binder& imu) {
    imu.numbers("position_m", v.imu_position_m, "in the body, metres");
    imu.numbers("roll_pitch_yaw_deg", v.imu_roll_pitch_yaw_deg,
                "of its axes in the body: about x, then y, then z, degrees");
  });
  b.group("gnss", "of the GNSS antenna", [&](Binder& gnss) {
    gnss.numbers("position_m", v.gnss_position_m, "in the body, metres");
    gnss.number("heading_offset_deg", v.gnss_heading_offset_deg, Range::between(-360, 360),
                "of the two antennas' baseline from the x axis, counterclockwise");
  });
  b.group("wheels", "of the wheels that have encoders", [&](Binder& wheels) {
    wheels.numbers("position_m", v.wheels_position_m, "middle of their axle in the body, metres");
    wheels.number("left_m_per_pulse", v.left_m_per_pulse, Range::between(-100, 100),
                  "distance per pulse");
    wheels.number("right_m_per_pulse", v.right_m_per_pulse, Range::between(-100, 100),
                  "distance per pulse");
  });
}

VehicleStatements vehicle_statements_of(const sensors::Rig& rig) {
  const auto position = [&](SensorKind kind) {
    const auto* sensor = rig.first(kind);
    const Eigen::Vector3d p =
        sensor == nullptr ? Eigen::Vector3d::Zero() : sensor->T_body_sensor.translation;
    return std::vector<double>{p.x(), p.y(), p.z()};
  };
  VehicleStatements v;
  v.imu_position_m = position(SensorKind::kImu);
  v.gnss_position_m = position(SensorKind::kGnss);
  v.wheels_position_m = position(SensorKind::kWheels);
  v.imu_roll_pitch_yaw_deg = {0, 0, 0};
  if (const auto* imu = rig.first(SensorKind::kImu)) {
    const Eigen::Matrix3d& R = imu->T_body_sensor.rotation;
    v.imu_roll_pitch_yaw_deg = {std::atan2(R(2, 1), R(2, 2)) / geometry::kDegree,
                                -std::asin(std::clamp(R(2, 0), -1.0, 1.0)) / geometry::kDegree,
                                std::atan2(R(1, 0), R(0, 0)) / geometry::kDegree};
  }
  if (const auto* gnss = rig.first(SensorKind::kGnss)) {
    const Eigen::Matrix3d& R = gnss->T_body_sensor.rotation;
    v.gnss_heading_offset_deg = std::atan2(R(1, 0), R(0, 0)) / geometry::kDegree;
  }
  if (const auto* wheels = rig.first(SensorKind::kWheels); wheels && wheels->encoder) {
    v.left_m_per_pulse = wheels->encoder->left_m_per_pulse;
    v.right_m_per_pulse = wheels->encoder->right_m_per_pulse;
  }
  return v;
}

Eigen::Matrix3d stated_rotation(const Statements& statements, const std::string& key,
                                const std::vector<double>& roll_pitch_yaw_deg) {
  if (roll_pitch_yaw_deg.empty()) return Eigen::Matrix3d::Identity();
  const Eigen::Vector3d rpy = geometry::kDegree * vector_of(statements, key, roll_pitch_yaw_deg);
  return geometry::exp_so3({0, 0, rpy.z()}) * geometry::exp_so3({0, rpy.y(), 0}) *
         geometry::exp_so3({rpy.x(), 0, 0});
}

void apply_vehicle(const Statements& statements, MountedSensor& sensor) {
  const VehicleStatements& v = statements->vehicle;
  if (sensor.kind == SensorKind::kImu) {
    place(statements, "vehicle.imu.position_m", v.imu_position_m, sensor);
    const std::string key = "vehicle.imu.roll_pitch_yaw_deg";
    if (!statements.states(key)) return;
    sensor.T_body_sensor.rotation = stated_rotation(statements, key, v.imu_roll_pitch_yaw_deg);
  }
  if (sensor.kind == SensorKind::kGnss) {
    place(statements, "vehicle.gnss.position_m", v.gnss_position_m, sensor);
    if (!statements.states("vehicle.gnss.heading_offset_deg")) return;
    sensor.T_body_sensor.rotation =
        geometry::exp_so3({0, 0, v.gnss_heading_offset_deg * geometry::kDegree});
  }
  if (sensor.kind == SensorKind::kWheels) {
    place(statements, "vehicle.wheels.position_m", v.wheels_position_m, sensor);
    if (v.left_m_per_pulse != 0 && v.right_m_per_pulse != 0) {
      sensor.encoder = {v.left_m_per_pulse, v.right_m_per_pulse};
    }
  }
}

}  // namespace traverse::dataset
