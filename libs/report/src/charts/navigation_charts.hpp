#pragma once

#include "run/model.hpp"
#include "run/run_data.hpp"

namespace traverse::report {

/// The charts of a run of navigation.
void add_navigation_charts(const RunData& run, Json& charts);

}  // namespace traverse::report
