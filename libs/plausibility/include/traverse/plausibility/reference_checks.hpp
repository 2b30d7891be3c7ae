#pragma once

#include <vector>

#include "traverse/geometry/trajectory.hpp"
#include "traverse/plausibility/finding.hpp"

namespace traverse::plausibility {

/// What in a reference contradicts an estimate as a whole, so that it is about the reference's
/// clock, frame, handedness or unit rather than about errors of the estimate. Both T_map_body; an
/// estimate that is wrong itself contradicts nothing, since no clock, frame or unit explains it.
std::vector<Finding> reference_findings(const geometry::Trajectory& estimate,
                                        const geometry::Trajectory& reference);

}  // namespace traverse::plausibility
