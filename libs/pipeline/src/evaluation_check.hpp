#pragma once

#include <filesystem>
#include <optional>

#include "traverse/evaluation/evaluate.hpp"
#include "traverse/geometry/trajectory.hpp"

namespace traverse::pipeline {

/// That an evaluation is of these trajectories: their poses, lengths and stamps are the ones that
/// it tells, its indices count poses that are there, and its numbers can be summed and squared.
/// \param file of the evaluation \param estimate_file of the estimate
/// \throws files::InputError
void require_evaluation(const evaluation::Evaluation& evaluation, const std::filesystem::path& file,
                        const geometry::Trajectory& estimate,
                        const std::filesystem::path& estimate_file,
                        const std::optional<geometry::Trajectory>& reference);

}  // namespace traverse::pipeline
