#pragma once

#include <string>

#include "figures/figure_maker.hpp"

namespace traverse::report {

/// The pictures of a run that has a comparison: errors along the way, over time and their spread,
/// the association, KITTI drift.
void add_error_figures(const RunData& run, FigureMaker& maker);

/// For each of the worst segments how a frame of it was registered: scan, matches and residuals.
/// Where the run kept none, a close-up of the map.
void add_worst_segment_figures(const RunData& run, const evaluation::WorstSegments& worst,
                               FigureMaker& maker);

/// "APE rmse 0.066 m, SE(3) alignment, 108 pairs"; empty if it was not computed.
std::string ape_statistic(const evaluation::Comparison& comparison);

}  // namespace traverse::report
