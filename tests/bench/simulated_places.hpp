#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "traverse/slam/scan_context.hpp"

namespace traverse::testing {

/// What loop search knows of a keyframe.
struct SimulatedPlace {
  slam::ScanContext context;
  Eigen::Vector3d p_map;
  double way_m = 0;  ///< driven until there
};

/// The keyframes of a long drive, one every two metres, as a VLP-16 of an eighth of its firings
/// sees them: through one simulated town after the other, each with a loop of about a kilometre
/// that is driven twice. The same ones for any number of threads.
std::vector<SimulatedPlace> simulated_places(std::size_t count);

}  // namespace traverse::testing
