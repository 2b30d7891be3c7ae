#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/evaluation/bootstrap.hpp"
#include "traverse/evaluation/evaluate.hpp"

#include "run/run_data.hpp"

namespace traverse::report {

/// A figure that a run is judged by: in headlines, budgets and comparisons.
struct RunFigure {
  std::string id;     ///< "ape_rmse_m": in report.json, budgets and comparisons
  std::string label;  ///< "APE"
  std::string unit;   ///< "m", or empty for counts
  std::string how;    ///< how it was made, in words
  double value = 0;
  std::optional<evaluation::Interval> interval;
  std::string no_interval;  ///< why there is none
  bool higher_is_better = false;
};

/// What a figure is, for documents and budgets.
struct FigureKind {
  std::string_view id;
  std::string_view label;
  std::string_view unit;
  std::string_view meaning;
  bool higher_is_better = false;  ///< else the lower the better; a budget is the least it may be
};

/// Every figure there can be, in the order in which they are told.
const std::vector<FigureKind>& figure_kinds();

/// Those that an evaluation defines.
std::vector<RunFigure> accuracy_figures(const evaluation::Evaluation& evaluation);

/// Those that a run defines: its accuracy, then its health, timing and cost.
std::vector<RunFigure> run_figures(const RunData& run);

/// The figure of that id, or null.
const RunFigure* find_figure(const std::vector<RunFigure>& figures, std::string_view id);

}  // namespace traverse::report
