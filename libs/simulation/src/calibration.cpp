#include <string>

#include <fmt/format.h>

#include "traverse/simulation/simulation.hpp"

namespace traverse::simulation {

namespace {

std::string row_of(const Eigen::Vector3d& v) {
  return fmt::format("[{}, {}, {}]", v.x(), v.y(), v.z());
}

std::string rows_of(const Eigen::Matrix3d& m) {
  return fmt::format("[{}, {}, {}]", row_of(m.row(0)), row_of(m.row(1)), row_of(m.row(2)));
}

std::string place_of(const sensors::MountedSensor& sensor) {
  const Eigen::Quaterniond q = sensor.T_body_sensor.quaternion();
  return fmt::format("{}:\n  t_body_sensor_m: {}\n  q_body_sensor_xyzw: [{}, {}, {}, {}]\n",
                     sensor.label, row_of(sensor.T_body_sensor.translation), q.x(), q.y(), q.z(),
                     q.w());
}

}  // namespace

std::string Simulation::calibration() const {
  std::string text =
      "# The vehicle as it was simulated. The body is the middle of the rear axle on the ground,\n"
      "# x ahead, y left, z up; p_body = R(q) p_sensor + t. A sensor reads y = M x + bias + "
      "noise.\n"
      "# The map of the reference is the plane east, north, up at the origin given under gnss.\n";
  const ImuSimulator imu(world_.imu, motion_, seed_of_drive());
  const ImuSimulator::Calibration& errors = imu.calibration();
  for (const sensors::MountedSensor& sensor : rig().sensors) {
    text += place_of(sensor);
    switch (sensor.kind) {
      case sensors::SensorKind::kImu:
        text += fmt::format(
            "  rate_hz: {}\n  gravity_mps2: {}\n  gyro_matrix: {}\n  accel_matrix: {}\n"
            "  gyro_bias_at_start: {}  # rad/s\n  accel_bias_at_start: {}  # m/s^2\n"
            "  gyro_noise: {}  # rad/s/sqrt(Hz)\n  accel_noise: {}  # m/s^2/sqrt(Hz)\n"
            "  gyro_bias_walk: {}  # rad/s^2/sqrt(Hz)\n  accel_bias_walk: {}  # m/s^3/sqrt(Hz)\n"
            "  stamps_late_s: {}\n",
            world_.imu.rate_hz, kGravity, rows_of(errors.gyro_matrix), rows_of(errors.accel_matrix),
            row_of(errors.gyro_bias), row_of(errors.accel_bias), world_.imu.gyro_noise,
            world_.imu.accel_noise, world_.imu.gyro_bias_walk, world_.imu.accel_bias_walk,
            world_.clock.imu_late_s);
        break;
      case sensors::SensorKind::kWheels:
        text += fmt::format(
            "  rate_hz: {}\n  radius_m: {}  # nominal\n  track_m: {}\n  pulses_per_turn: {}\n"
            "  stamps_late_s: {}\n",
            world_.wheels.rate_hz, world_.wheels.radius_m, world_.wheels.track_m,
            world_.wheels.pulses_per_turn, world_.clock.wheels_late_s);
        break;
      case sensors::SensorKind::kGnss:
        text += fmt::format(
            "  rate_hz: {}\n  map_origin_latitude_deg: {}\n  map_origin_longitude_deg: {}\n"
            "  map_origin_altitude_m: {}\n  stamps_late_s: {}\n",
            world_.gnss.rate_hz, world_.gnss.latitude_deg, world_.gnss.longitude_deg,
            world_.gnss.altitude_m, world_.clock.gnss_late_s);
        break;
      default:
        break;
    }
  }
  return text;
}

}  // namespace traverse::simulation
