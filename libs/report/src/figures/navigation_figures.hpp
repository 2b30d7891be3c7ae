#pragma once

#include <vector>

#include "traverse/render/plot/range.hpp"

#include "figures/figure_maker.hpp"

namespace traverse::report {

/// The pictures of a run of navigation.
void add_navigation_figures(const RunData& run, FigureMaker& maker);

/// Stretches of time in which `flags` are not zero, half way to the frames beside them.
std::vector<render::Range> spans_where(const std::vector<double>& times,
                                       const std::vector<double>& flags);

}  // namespace traverse::report
