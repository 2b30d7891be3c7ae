#pragma once

#include <cstddef>
#include <vector>

#include "traverse/optimization/factor_kind.hpp"
#include "traverse/pipeline/run_folder.hpp"

namespace traverse::pipeline {

/// Every factor whose Jacobians are checked: those that each library of Traverse has, and those
/// that were registered.
std::vector<optimization::FactorKind> factor_kinds();

/// The inertial factor between a frame of a navigation run and the one before it, at the states
/// that were estimated. \param frame  as frames.csv counts it, not the first
/// \throws files::InputError if the run is of another kind or has no such frame
std::vector<optimization::FactorKind> factor_kinds_of_run(const RunFolder& run, std::size_t frame);

/// Adds factors of your own, which a run then checks when an estimator says that it solves with
/// them (lidar::Odometry::factors()). Call it before runs begin; other threads must not ask for the
/// kinds meanwhile. \throws std::invalid_argument if there is a factor of such a name.
void register_factor_kinds(std::vector<optimization::FactorKind> kinds);

}  // namespace traverse::pipeline
