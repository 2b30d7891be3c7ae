#include "frame_sensor.hpp"

namespace traverse::replay {

std::string frame_sensor(const sensors::Rig& rig) {
  using sensors::SensorKind;
  for (const auto kind : {SensorKind::kLidar, SensorKind::kPlanarLaser, SensorKind::kWheels,
                          SensorKind::kGnss, SensorKind::kImu}) {
    if (const auto* sensor = rig.first(kind)) return sensor->label;
  }
  return {};
}

}  // namespace traverse::replay
