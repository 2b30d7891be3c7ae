#pragma once

#include <span>

#include "checks/check.hpp"

namespace traverse::plausibility {

/// The codes of reference_findings(), which looks at trajectories instead of measurements.
std::span<const CodeMeaning> reference_codes();

}  // namespace traverse::plausibility
