#pragma once

#include <vector>

#include "figures/run_figures.hpp"
#include "run/model.hpp"
#include "run/run_data.hpp"

/// Each fills its part of the report.
namespace traverse::report {

struct BudgetResult;

void add_verdict(const RunData& run, const std::vector<RunFigure>& figures, Model& model);
/// \param budget null if none was given
void add_headlines(const std::vector<RunFigure>& figures, const BudgetResult* budget, Model& model);
void add_accuracy(const RunData& run, Model& model);
void add_worst_segments(const RunData& run, const evaluation::WorstSegments& worst, Model& model);
void add_health(const RunData& run, Model& model);
void add_timing(const RunData& run, Model& model);
/// Nothing where the run folder has no factors.
void add_factors(const RunData& run, Model& model);
/// Nothing where the run closed no loops over its odometry.
void add_loops(const RunData& run, Model& model);
/// Nothing where the run was not a navigation of IMU, GNSS and wheels.
void add_navigation(const RunData& run, Model& model);
void add_provenance(const RunData& run, Model& model);

}  // namespace traverse::report
