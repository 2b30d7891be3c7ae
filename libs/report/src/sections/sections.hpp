#pragma once

#include <vector>

#include "figures/run_figures.hpp"
#include "run/model.hpp"
#include "run/run_data.hpp"

/// Each fills its part of the report; report_sections.cpp says where they stand.
namespace traverse::report {

struct BudgetResult;

void add_verdict(const RunData& run, const std::vector<RunFigure>& figures, Model& model);
/// \param budget null if none was given
void add_headlines(const RunData& run, const std::vector<RunFigure>& figures,
                   const BudgetResult* budget, Model& model);
/// Of a run that has a comparison.
void add_accuracy(const RunData& run, Model& model);
/// Whether the run was held against surveyed points, a prism or fixes.
bool has_checkpoints(const RunData& run);
void add_checkpoints(const RunData& run, Model& model);
/// Nothing where the map was not scored.
void add_map_sharpness(const RunData& run, Model& model);
void add_worst_segments(const RunData& run, const evaluation::WorstSegments& worst, Model& model);
void add_health(const RunData& run, Model& model);
void add_timing(const RunData& run, Model& model);

/// Whether the run folder has factors that were checked or measured.
bool has_factors(const RunData& run);
void add_factors(const RunData& run, Model& model);

/// Whether the run closed loops over its odometry.
bool closes_loops(const RunData& run);
void add_loops(const RunData& run, Model& model);

/// Whether the run was a navigation of IMU, GNSS and wheels.
bool is_navigation_run(const RunData& run);
void add_navigation(const RunData& run, Model& model);

void add_configuration(const RunData& run, Model& model);
void add_provenance(const RunData& run, Model& model);

}  // namespace traverse::report
