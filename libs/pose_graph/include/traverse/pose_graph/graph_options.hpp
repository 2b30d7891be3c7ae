#pragma once

#include "traverse/config/binder.hpp"

namespace traverse::pose_graph {

struct GraphOptions {
  bool robust = true;  ///< loops, fixes and ups that contradict the rest lose their weight
  /// A consistent one is beyond this bound with this probability; the weight falls there.
  double outlier_probability = 0.01;
  double graduation = 4;       ///< the bound shrinks by this factor a stage, 1.4 .. 100
  int steps_a_stage = 2;       ///< Levenberg-Marquardt steps before the bound shrinks again
  int max_iterations = 50;     ///< of the last stage
  double min_fix_spread = 10;  ///< fixes orient the map when they reach so many of their sigmas
  double up_offset_deg = 0.5;  ///< standard deviation of what all measured ups share
};
void bind(config::Binder& binder, GraphOptions& options);

}  // namespace traverse::pose_graph
