#pragma once

#include <vector>

#include "traverse/optimization/factor_kind.hpp"

namespace traverse::pipeline {

/// Every factor of Traverse whose Jacobians are checked: those that each library registers.
std::vector<optimization::FactorKind> factor_kinds();

}  // namespace traverse::pipeline
