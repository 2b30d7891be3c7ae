#pragma once

#include <string>

#include "run/model.hpp"
#include "run/run_data.hpp"

namespace traverse::report {

/// What the 3-D view of the page shows, under "scene": the way, the reference and how the points of
/// the map are packed. Returns the packed points (packed_points.hpp).
std::string add_scene(const RunData& run, Model& model);

}  // namespace traverse::report
