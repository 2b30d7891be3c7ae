#include "traverse/mrpt_io/point_attributes.hpp"

#include <memory>

#include "traverse/mrpt_io/mrpt_values.hpp"

namespace traverse::mrpt_io {

namespace {

constexpr const char* kLabel = "point attributes";

}  // namespace

mrpt::obs::CObservationRawDAQ::Ptr to_observation(const PointAttributes& attributes,
                                                  geometry::Stamp stamp) {
  auto observation = mrpt::obs::CObservationRawDAQ::Create();
  observation->timestamp = to_mrpt(stamp);
  observation->sensorLabel = kLabel;
  observation->AIN_channel_count = 1;
  observation->AIN_float = attributes.time;
  observation->AIN_16bits = attributes.ring;
  observation->AOUT_float = attributes.intensity;
  return observation;
}

bool holds_attributes(const mrpt::obs::CObservation& observation) {
  return observation.sensorLabel == kLabel &&
         dynamic_cast<const mrpt::obs::CObservationRawDAQ*>(&observation) != nullptr;
}

PointAttributes attributes_of(const mrpt::obs::CSensoryFrame& frame, std::size_t points) {
  PointAttributes attributes;
  const auto found = std::dynamic_pointer_cast<mrpt::obs::CObservationRawDAQ>(
      frame.getObservationBySensorLabel(kLabel));
  if (found == nullptr) return attributes;
  if (found->AIN_float.size() == points) attributes.time = found->AIN_float;
  if (found->AIN_16bits.size() == points) attributes.ring = found->AIN_16bits;
  if (found->AOUT_float.size() == points) attributes.intensity = found->AOUT_float;
  return attributes;
}

}  // namespace traverse::mrpt_io
