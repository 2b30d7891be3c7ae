#pragma once

#include <vector>

#include "traverse/evaluation/worst_segments.hpp"

#include "figures/run_figures.hpp"
#include "run/run_data.hpp"

namespace traverse::report {

struct BudgetResult;

/// What the report of a run is made from.
struct ReportInput {
  const RunData& run;
  const std::vector<RunFigure>& figures;  ///< of the run
  const evaluation::WorstSegments& worst;
  const BudgetResult* budget = nullptr;  ///< null if none was given
};

}  // namespace traverse::report
