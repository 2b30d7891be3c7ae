#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "traverse/statistics/quantile.hpp"

#include "run/number_texts.hpp"
#include "sections/sections.hpp"

namespace traverse::report {

namespace {

/// What became of the candidates, with the measures that decided.
Table outcomes_table(const std::vector<slam::Loop>& loops) {
  Table table("loop_outcomes", "Candidates",
              {"outcome", "candidates", "of them by appearance", "overlap, median",
               "residual, median [m]", "chi-square to odometry, median"});
  std::map<slam::LoopVerdict, std::vector<const slam::Loop*>> by_verdict;
  for (const slam::Loop& loop : loops) by_verdict[loop.verdict].push_back(&loop);
  for (const auto& [verdict, group] : by_verdict) {
    std::vector<double> overlap, residual, chi2;
    std::size_t by_appearance = 0;
    for (const slam::Loop* loop : group) {
      overlap.push_back(loop->overlap);
      residual.push_back(loop->residual_rms_m);
      chi2.push_back(loop->odometry_chi2);
      by_appearance += loop->source == slam::LoopSource::kAppearance ? 1 : 0;
    }
    table.add_row({std::string(name_of(verdict)), Cell::count(group.size()),
                   Cell::count(by_appearance), statistics::median(overlap),
                   statistics::median(residual), statistics::median(chi2)});
  }
  return table;
}

const evaluation::Ape* position_error(const evaluation::Evaluation& evaluation) {
  if (!evaluation.comparison) return nullptr;
  for (const evaluation::Ape& ape : evaluation.comparison->ape) {
    if (ape.relation == evaluation::Relation::kTranslation) return &ape;
  }
  return nullptr;
}

/// The same figures of odometry alone and after loops were closed.
Table before_after_table(const RunData& run) {
  Table table("loops_before_after", "Odometry and SLAM", {"figure", "odometry", "SLAM"});
  const evaluation::Evaluation& before = *run.odometry_evaluation;
  const evaluation::Evaluation& after = run.evaluation;
  const auto* ape_before = position_error(before);
  const auto* ape_after = position_error(after);
  if (ape_before != nullptr && ape_after != nullptr) {
    table.add_row({"APE rmse [m]", ape_before->statistics.rmse, ape_after->statistics.rmse});
    table.add_row({"APE, largest [m]", ape_before->statistics.max, ape_after->statistics.max});
    table.add_row({"closing error [m]", before.comparison->path.end_error_m,
                   after.comparison->path.end_error_m});
    table.add_row({"end rotation [deg]", before.comparison->path.end_rotation_deg,
                   after.comparison->path.end_rotation_deg});
  }
  if (before.consistency && after.consistency) {
    table.add_row({"map entropy (MME)", before.consistency->mme, after.consistency->mme});
  }
  return table;
}

Table residuals_table(const std::vector<slam::Loop>& loops) {
  Table table("loop_residuals", "Loops in the graph",
              {"loops", "mean chi-square / 6", "largest", "of less weight than one half"});
  double sum = 0;
  double largest = 0;
  std::size_t count = 0;
  std::size_t light = 0;
  for (const slam::Loop& loop : loops) {
    if (!loop.is_accepted() && loop.verdict != slam::LoopVerdict::kOutvoted) continue;
    ++count;
    sum += loop.graph_chi2 / 6;
    largest = std::max(largest, loop.graph_chi2 / 6);
    light += loop.weight < 0.5 ? 1 : 0;
  }
  if (count > 0) {
    table.add_row(
        {Cell::count(count), sum / static_cast<double>(count), largest, Cell::count(light)});
  }
  return table;
}

std::string how_text(const std::vector<slam::Loop>& loops) {
  const auto accepted = std::count_if(loops.begin(), loops.end(),
                                      [](const slam::Loop& loop) { return loop.is_accepted(); });
  if (accepted == 0) {
    return fmt::format("None of {} candidates was accepted; the trajectory is odometry's.",
                       count_text(loops.size()));
  }
  return fmt::format(
      "{} of {} candidates were accepted. The trajectory of this report is the "
      "optimised one; odometry went on undisturbed.",
      count_text(static_cast<std::size_t>(accepted)), count_text(loops.size()));
}

}  // namespace

bool closes_loops(const RunData& run) { return run.loops && run.odometry_evaluation; }

void add_loops(const RunData& run, Model& model) {
  model.add_text("loops_how", how_text(*run.loops));
  model.add_table(before_after_table(run));
  model.add_table(outcomes_table(*run.loops));
  model.add_table(residuals_table(*run.loops));
}

}  // namespace traverse::report
