#pragma once

#include <string>

#include "traverse/pipeline/sensor_use.hpp"

namespace traverse::pipeline {

/// How the readings of a sensor that were rejected lie together: "in stretches of up to 3.4 s", or
/// "no two in a row".
std::string rejections_text(const SensorUse& sensor);

}  // namespace traverse::pipeline
