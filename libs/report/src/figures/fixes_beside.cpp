#include "figures/fixes_beside.hpp"

#include <algorithm>
#include <cmath>

#include "charts/navigation_series.hpp"
#include "charts/series.hpp"

namespace traverse::report {

namespace {

/// The frame with the largest jump of the path.
struct WorstJump {
  const RunData* run = nullptr;
  std::size_t frame = 0;
  double jump_m = 0;
};

WorstJump worst_jump(const std::vector<const RunData*>& runs) {
  WorstJump worst;
  for (const RunData* run : runs) {
    const std::vector<double> jumps = at_fixes(run->frames, "correction_m");
    for (std::size_t i = 0; i < std::min(jumps.size(), run->estimate.size()); ++i) {
      if (std::isfinite(jumps[i]) && jumps[i] > worst.jump_m) worst = {run, i, jumps[i]};
    }
  }
  return worst;
}

/// What is shown of the place of a jump: it, and the way of 1.5 s before and after.
double detail_width_m(const RunData& run, const WorstJump& worst) {
  constexpr double kJumps = 10;     // times the jump
  constexpr double kSeconds = 1.5;  // of the way, to each side
  const double speed_mps = run.frames.column("speed_mps").at(worst.frame);
  return std::max(kJumps * worst.jump_m, 2 * kSeconds * speed_mps);
}

}  // namespace

render::BesideTrajectories fixes_beside(const std::vector<const RunData*>& runs) {
  render::BesideTrajectories beside;
  const RunData& first = *runs.front();
  if (!is_navigation(first.frames)) return beside;
  const PlacedFixes fixes = placed_fixes(first.frames);
  for (const Eigen::Vector3d& p : fixes.taken)
    beside.fixes.taken.push_back(aligned_place(first, p));
  for (const Eigen::Vector3d& p : fixes.rejected) {
    beside.fixes.rejected.push_back(aligned_place(first, p));
  }
  const WorstJump worst = worst_jump(runs);
  if (worst.run == nullptr) return beside;
  const Eigen::Vector3d place = worst.run->estimate.pose(worst.frame).translation;
  beside.detail =
      render::MapDetail{aligned_place(*worst.run, place), detail_width_m(*worst.run, worst)};
  return beside;
}

}  // namespace traverse::report
