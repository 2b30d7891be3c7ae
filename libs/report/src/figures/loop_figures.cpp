#include "figures/loop_figures.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "traverse/evaluation/alignment.hpp"
#include "traverse/render/pictures/loops_from_above.hpp"

#include "charts/series.hpp"
#include "run/number_texts.hpp"

namespace traverse::report {

namespace {

constexpr double kLongestGap_s = 10;

geometry::Trajectory aligned(const geometry::Trajectory& trajectory,
                             const evaluation::Evaluation& evaluation) {
  if (!evaluation.comparison) return trajectory;
  return geometry::Trajectory::stamped(
      trajectory.stamps(),
      to_vector(evaluation::aligned(trajectory.poses(), evaluation.comparison->alignment)));
}

}  // namespace

void add_loop_figures(const RunData& run, FigureMaker& maker) {
  if (!run.loops || !run.odometry || !run.odometry_evaluation) return;
  const geometry::Trajectory optimised = aligned_estimate(run);
  const geometry::Trajectory odometry = aligned(*run.odometry, *run.odometry_evaluation);
  std::vector<render::LoopMark> marks;
  std::size_t accepted = 0;
  for (const slam::Loop& loop : *run.loops) {
    const auto here = optimised.at(loop.stamp, kLongestGap_s);
    const auto there = optimised.at(loop.candidate_stamp, kLongestGap_s);
    if (!here || !there) continue;
    marks.push_back({here->translation, there->translation, loop.is_accepted()});
    accepted += loop.is_accepted() ? 1 : 0;
  }
  const std::string statistic =
      fmt::format("{} loops closed, {} candidates rejected", count_text(accepted),
                  count_text(marks.size() - accepted));
  maker.add("loops", "loops-above",
            "Where loops were closed (dots), and which candidates were rejected "
            "(lines between the two).",
            [&](const render::Style& style) {
              return render::loops_from_above(optimised, accepted > 0 ? &odometry : nullptr, marks,
                                              maker.caption("Loops", statistic), style);
            });
}

}  // namespace traverse::report
