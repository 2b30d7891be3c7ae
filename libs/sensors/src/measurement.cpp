#include "traverse/sensors/measurement.hpp"

namespace traverse::sensors {

namespace {

template <typename T>
const T& value_of(const T& value) {
  return value;
}
template <typename T>
const T& value_of(const std::shared_ptr<const T>& value) {
  return *value;
}

}  // namespace

geometry::Stamp stamp_of(const Measurement& measurement) {
  return std::visit([](const auto& held) { return value_of(held).stamp; }, measurement);
}

const std::string& sensor_of(const Measurement& measurement) {
  return std::visit([](const auto& held) -> const std::string& { return value_of(held).sensor; },
                    measurement);
}

}  // namespace traverse::sensors
