#pragma once

#include "figures/figure_maker.hpp"

namespace traverse::report {

/// The trajectory from above and from the side, over the reference where it was matched.
void add_trajectory_figures(const RunData& run, FigureMaker& maker);

}  // namespace traverse::report
