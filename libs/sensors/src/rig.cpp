#include "traverse/sensors/rig.hpp"

#include <algorithm>

namespace traverse::sensors {

namespace {

template <typename Predicate>
const MountedSensor* first_where(const std::vector<MountedSensor>& sensors, Predicate predicate) {
  const auto found = std::find_if(sensors.begin(), sensors.end(), predicate);
  return found == sensors.end() ? nullptr : &*found;
}

}  // namespace

std::string_view name_of(SensorKind kind) {
  switch (kind) {
    case SensorKind::kLidar:
      return "lidar";
    case SensorKind::kPlanarLaser:
      return "2-D laser";
    case SensorKind::kImu:
      return "IMU";
    case SensorKind::kGnss:
      return "GNSS";
    case SensorKind::kWheels:
      return "wheels";
  }
  return "unknown";
}

const MountedSensor* Rig::find(std::string_view label) const {
  return first_where(sensors, [&](const MountedSensor& s) { return s.label == label; });
}

const MountedSensor* Rig::first(SensorKind kind) const {
  return first_where(sensors, [&](const MountedSensor& s) { return s.kind == kind; });
}

}  // namespace traverse::sensors
