#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "traverse/evaluation/evaluate.hpp"
#include "traverse/geometry/trajectory.hpp"

namespace traverse::report {

/// Two trajectories and what came out of their comparison.
struct ComparedTrajectories {
  const geometry::Trajectory& estimate;
  const geometry::Trajectory& reference;
  const evaluation::Evaluation& evaluation;  ///< with a comparison
  std::string estimate_name;                 ///< on the pictures
  std::string reference_name;
};

/// Draws the pictures of a run's report that need nothing but trajectories: from above and from the
/// side, errors on the trajectory, over time and distance, their distribution, association, KITTI
/// drift. As PNG for light and (`_dark`) dark pages, those of lines as SVG and PDF too.
/// \param folder made if it is not there; files of other names in it stay
/// \returns how many pictures \throws files::OutputError
std::size_t draw_evaluation(const ComparedTrajectories& compared,
                            const std::filesystem::path& folder);

}  // namespace traverse::report
