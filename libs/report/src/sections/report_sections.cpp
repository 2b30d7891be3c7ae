#include "sections/report_sections.hpp"

#include <array>

#include "charts/charts.hpp"
#include "charts/navigation_charts.hpp"
#include "charts/navigation_series.hpp"
#include "figures/frame_figures.hpp"
#include "figures/loop_figures.hpp"
#include "figures/map_figures.hpp"
#include "figures/navigation_figures.hpp"
#include "figures/trajectory_figures.hpp"
#include "sections/budget_check.hpp"
#include "sections/error_figures.hpp"
#include "sections/sections.hpp"

namespace traverse::report {

namespace {

bool always(const RunData& /*run*/) { return true; }

/// What an estimator tells of its frames; of another program's poses it is not known.
bool tells_health(const RunData& run) { return !run.health.is_foreign; }

bool tells_times(const RunData& run) { return !run.record.at("timing_ms").is_null(); }

bool has_comparison(const RunData& run) { return run.evaluation.comparison.has_value(); }

void fill_verdict(const ReportInput& input, Model& model) {
  add_verdict(input.run, input.figures, model);
  add_headlines(input.run, input.figures, input.budget, model);
  if (input.budget != nullptr) add_budget(*input.budget, model);
}

/// A section that is filled or drawn from the run alone.
template <void (*kFill)(const RunData&, Model&)>
void fill_from_run(const ReportInput& input, Model& model) {
  kFill(input.run, model);
}
template <void (*kDraw)(const RunData&, FigureMaker&)>
void draw_from_run(const ReportInput& input, FigureMaker& maker) {
  kDraw(input.run, maker);
}

constexpr std::array<ReportSection, 13> kReportSections{{
    {"verdict", "Verdict", always, fill_verdict},
    {"trajectory", "Trajectory", always,
     [](const ReportInput& input, Model& model) {
       model.page.set("has_comparison", has_comparison(input.run));
     },
     draw_from_run<add_trajectory_figures>},
    {"loops", "Loops", closes_loops, fill_from_run<add_loops>, draw_from_run<add_loop_figures>},
    {"error", "Error", has_comparison, fill_from_run<add_accuracy>,
     draw_from_run<add_error_figures>, add_error_charts},
    {"checkpoints", "Surveyed points", has_checkpoints, fill_from_run<add_checkpoints>},
    {"navigation", "Navigation", is_navigation_run, fill_from_run<add_navigation>,
     draw_from_run<add_navigation_figures>, add_navigation_charts},
    {"worst", "Worst segments", always,
     [](const ReportInput& input, Model& model) {
       add_worst_segments(input.run, input.worst, model);
     },
     [](const ReportInput& input, FigureMaker& maker) {
       add_worst_segment_figures(input.run, input.worst, maker);
     }},
    {"map", "Map", always, fill_from_run<add_map_sharpness>, draw_from_run<add_map_figures>},
    {"health", "Health", tells_health, fill_from_run<add_health>, draw_from_run<add_health_figures>,
     add_health_charts},
    {"timing", "Timing", tells_times, fill_from_run<add_timing>, draw_from_run<add_timing_figures>,
     add_timing_charts},
    {"factors", "Factors", has_factors, fill_from_run<add_factors>},
    {"configuration", "Configuration", always, fill_from_run<add_configuration>},
    {"provenance", "Provenance", always, fill_from_run<add_provenance>},
}};

}  // namespace

std::span<const ReportSection> report_sections() { return kReportSections; }

}  // namespace traverse::report
