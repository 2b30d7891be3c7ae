#pragma once

#include <vector>

#include "traverse/loam/registration.hpp"
#include "traverse/optimization/factor_kind.hpp"

namespace traverse::loam {

/// Whether the points of a match stand at the pose's moment, or each has seen its part of the
/// sweep.
enum class Sweep { kDeskewed, kSwept };

/// The factors of registration for the check of their Jacobians: line vector, line scalar, plane
/// signed, plane absolute, of deskewed and of swept points, derived for both perturbations.
std::vector<optimization::FactorKind> factor_kinds();

/// The two of them that solve_pose works with: that of lines and that of planes.
std::vector<optimization::FactorUse> factors_of(const SolverOptions& options,
                                                Sweep sweep = Sweep::kDeskewed);

}  // namespace traverse::loam
