#pragma once

#include <string>
#include <vector>

#include "figures/run_figures.hpp"
#include "run/model.hpp"
#include "run/run_data.hpp"

namespace traverse::report {

struct BudgetResult;

/// Everything of a report but its pictures.
struct ReportModel {
  Model model;
  std::string packed_points;  ///< of the 3-D view
};

/// \param budget null if none was given
ReportModel make_model(const RunData& run, const std::vector<RunFigure>& figures,
                       const evaluation::WorstSegments& worst, const BudgetResult* budget);

}  // namespace traverse::report
