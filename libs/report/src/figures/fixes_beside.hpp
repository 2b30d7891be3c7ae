#pragma once

#include <vector>

#include "traverse/render/pictures/trajectory_from_above.hpp"

#include "run/run_data.hpp"

namespace traverse::report {

/// The fixes of the first of runs of one recording, and where any of them jumps most, as they stand
/// beside its aligned_estimate(); nothing of runs without fixes.
render::BesideTrajectories fixes_beside(const std::vector<const RunData*>& runs);

}  // namespace traverse::report
