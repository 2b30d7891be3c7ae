#pragma once

#include "run/model.hpp"
#include "run/run_data.hpp"

namespace traverse::report {

/// The series of the interactive charts under "charts" and what belongs to each pose under "poses".
void add_charts(const RunData& run, Model& model);

}  // namespace traverse::report
