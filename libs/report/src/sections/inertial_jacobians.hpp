#pragma once

#include "run/model.hpp"
#include "run/run_data.hpp"

namespace traverse::report {

/// The 14 blocks of the inertial factor at two states in the middle of a navigation run, analytic
/// beside numeric; nothing for another run or one that does not tell its states.
void add_inertial_jacobians(const RunData& run, Model& model);

}  // namespace traverse::report
