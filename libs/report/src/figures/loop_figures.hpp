#pragma once

#include "figures/figure_maker.hpp"

namespace traverse::report {

/// Nothing where the run closed no loops.
void add_loop_figures(const RunData& run, FigureMaker& maker);

}  // namespace traverse::report
