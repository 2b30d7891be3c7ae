#pragma once

#include <vector>

#include "traverse/inertial/nav_state.hpp"
#include "traverse/inertial/navigation_options.hpp"
#include "traverse/optimization/factor_kind.hpp"

namespace traverse::inertial {

/// The factors of navigation for the check of their Jacobians, at states away from zero residual
/// and biases away from those that were integrated about. Only the blocks that a factor depends on
/// are parameters, so that the inertial one shows its 14 non-zero blocks row by row:
/// "inertial rotation", "inertial velocity" and "inertial position".
std::vector<optimization::FactorKind> factor_kinds();

/// The three inertial ones at two states that a run estimated, with what a constant rate and
/// acceleration from one to the other read on an IMU with the biases of the first.
/// \param gravity_map  (0, 0, -9.8) [m/s^2] \throws std::invalid_argument unless j is the later
std::vector<optimization::FactorKind> inertial_kinds_between(const NavState& i, const NavState& j,
                                                             const Eigen::Vector3d& gravity_map);

/// Those that navigation solves with. \param has_gnss, has_wheels  in the recording
std::vector<optimization::FactorUse> factors_of(const NavigationOptions& options, bool has_gnss,
                                                bool has_wheels);

/// Those of an InertialChain that is constrained by a sensor's poses.
std::vector<optimization::FactorUse> factors_of_chain(bool has_wheels);

}  // namespace traverse::inertial
