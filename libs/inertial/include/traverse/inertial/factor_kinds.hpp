#pragma once

#include <vector>

#include "traverse/inertial/navigation_options.hpp"
#include "traverse/optimization/factor_kind.hpp"

namespace traverse::inertial {

/// The factors of navigation for the check of their Jacobians, at states away from zero residual
/// and biases away from those that were integrated about. Only the blocks that a factor depends on
/// are parameters, so that the inertial one shows its 14 non-zero blocks row by row:
/// "inertial rotation", "inertial velocity" and "inertial position".
std::vector<optimization::FactorKind> factor_kinds();

/// Those that navigation solves with. \param has_gnss, has_wheels  in the recording
std::vector<optimization::FactorUse> factors_of(const NavigationOptions& options, bool has_gnss,
                                                bool has_wheels);

}  // namespace traverse::inertial
