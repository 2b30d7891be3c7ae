#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "traverse/optimization/factor_kind.hpp"
#include "traverse/pipeline/run_folder.hpp"

namespace traverse::pipeline {

struct RunContents;

/// Every factor whose Jacobians are checked: those that each library of Traverse has, and those
/// that were registered.
std::vector<optimization::FactorKind> factor_kinds();

/// The inertial factor between a frame of a navigation run and the one before it, at the states
/// that were estimated. \param frame  as frames.csv counts it, not the first
/// \throws files::InputError if the run is of another kind or has no such frame
std::vector<optimization::FactorKind> factor_kinds_of_run(const RunFolder& run, std::size_t frame);
/// The same of a run that was read.
std::vector<optimization::FactorKind> factor_kinds_of_run(const RunContents& run,
                                                          std::size_t frame);

/// Whether the frames of a run tell the states that its inertial factors are between; those of a
/// version before 0.2 do not.
bool tells_states(const RunContents& run);

/// A block's derivative as Forster et al. and the book write it, "dv/dbg1": of the residual of
/// rotation, velocity or position, in a part of the state before (1) or after (2). Of factors that
/// are not inertial the block's own name.
std::string book_name(const std::string& factor, const std::string& block);

/// Adds factors of your own, which a run then checks when an estimator says that it solves with
/// them (lidar::Odometry::factors()). Call it before runs begin; other threads must not ask for the
/// kinds meanwhile. \throws std::invalid_argument if there is a factor of such a name.
void register_factor_kinds(std::vector<optimization::FactorKind> kinds);

}  // namespace traverse::pipeline
