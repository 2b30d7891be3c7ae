#include "traverse/dataset/recording_slice.hpp"

#include <memory>
#include <variant>

namespace traverse::dataset {

namespace {

/// The sensor whose scans are the frames.
std::string frame_sensor(const sensors::Rig& rig, const std::string& wanted) {
  if (!wanted.empty()) return wanted;
  for (const auto kind : {sensors::SensorKind::kLidar, sensors::SensorKind::kPlanarLaser}) {
    if (const auto* sensor = rig.first(kind)) return sensor->label;
  }
  return {};
}

}  // namespace

SliceCount for_each_in_slice(Source& source, const Slice& slice,
                             const std::function<void(const sensors::Measurement&)>& use) {
  const std::string sensor = frame_sensor(source.info().rig, slice.lidar);
  SliceCount count;
  std::size_t frames_seen = 0;
  while (const auto measurement = source.next()) {
    const bool is_frame = sensor_of(*measurement) == sensor;
    if (is_frame && frames_seen > slice.last) break;
    const bool is_inside = frames_seen >= slice.first;
    if (is_inside) {
      use(*measurement);
      ++(is_frame ? count.frames : count.others);
    }
    frames_seen += is_frame ? 1 : 0;
  }
  return count;
}

}  // namespace traverse::dataset
