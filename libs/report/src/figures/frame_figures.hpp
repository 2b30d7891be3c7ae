#pragma once

#include "figures/figure_maker.hpp"

namespace traverse::report {

/// Registration over time, where frames are registered scans.
void add_health_figures(const RunData& run, FigureMaker& maker);

/// The time of each stage.
void add_timing_figures(const RunData& run, FigureMaker& maker);

}  // namespace traverse::report
