#pragma once

#include <string>
#include <vector>

#include "figures/run_figures.hpp"
#include "run/model.hpp"
#include "run/run_data.hpp"

namespace traverse::report {

/// A run that takes part in a comparison.
struct ComparedRun {
  std::string name;
  RunData data;
  std::vector<RunFigure> figures;

  bool is_lost() const { return data.health.verdict == pipeline::Health::kLost; }
};

enum class Change {
  kImproved,
  kNoChange,
  kRegressed,
  kUnknown,  ///< too few values
  kLost      ///< of two runs one of which is lost: its figures are of a path that nobody drove
};

/// A difference that may be due to chance: all of `interval` must lie beyond `threshold` for it to
/// count. Lower is better.
Change judge(const evaluation::Interval& interval, double threshold);
std::string to_text(Change change);

/// What the page and the terminal show: "figures" (a row per figure, a column per run),
/// "differences" (a row per figure and run but the baseline), "wins" (a row per run), "stretches"
/// (a row per stretch of the drive) and "settings" (a row per setting that differs).
std::vector<Table> comparison_tables(const std::vector<ComparedRun>& runs,
                                     double threshold_percent);

/// Errors of all runs over time under "charts", with their "poses".
void add_comparison_charts(const std::vector<ComparedRun>& runs, Model& model);

}  // namespace traverse::report
