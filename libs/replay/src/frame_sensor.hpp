#pragma once

#include <string>

#include "traverse/sensors/measurement.hpp"
#include "traverse/sensors/rig.hpp"

namespace traverse::replay {

/// The sensor whose measurements are the frames of a recording: the first lidar; without one the
/// first 2-D laser, else wheels, GNSS receiver, IMU. Empty if the rig has no sensor.
std::string frame_sensor(const sensors::Rig& rig);

/// Whether the measurement is a frame.
inline bool is_frame(const sensors::Measurement& measurement, const std::string& frame_sensor) {
  return sensors::sensor_of(measurement) == frame_sensor;
}

}  // namespace traverse::replay
