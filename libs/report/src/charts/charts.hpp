#pragma once

#include "run/model.hpp"
#include "run/run_data.hpp"

/// The interactive charts of each section, as report.json has them.
namespace traverse::report {

/// Of a run that has a comparison.
void add_error_charts(const RunData& run, Json& charts);
void add_health_charts(const RunData& run, Json& charts);
void add_timing_charts(const RunData& run, Json& charts);

/// What belongs to each pose, under "poses".
void add_poses(const RunData& run, Model& model);

}  // namespace traverse::report
