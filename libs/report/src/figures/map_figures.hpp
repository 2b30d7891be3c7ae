#pragma once

#include "figures/figure_maker.hpp"

namespace traverse::report {

/// The map from above, in perspective and in slices, and a scan of the run with its features.
void add_map_figures(const RunData& run, FigureMaker& maker);

}  // namespace traverse::report
