#pragma once

#include <vector>

#include "traverse/optimization/factor_kind.hpp"

namespace traverse::pose_graph {

/// The factors of pose graphs for the check of their Jacobians: "between poses", "antenna position"
/// and "up direction".
std::vector<optimization::FactorKind> factor_kinds();

}  // namespace traverse::pose_graph
