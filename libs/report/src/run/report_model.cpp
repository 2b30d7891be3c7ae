#include "run/report_model.hpp"

#include "charts/charts.hpp"
#include "page/scene.hpp"
#include "sections/budget_check.hpp"
#include "sections/sections.hpp"

namespace traverse::report {

ReportModel make_model(const RunData& run, const std::vector<RunFigure>& figures,
                       const evaluation::WorstSegments& worst, const BudgetResult* budget) {
  ReportModel report;
  Model& model = report.model;
  model.json["schema"] = "traverse/report/1";
  model.add_text("recording", run.recording_name());
  model.add_text("pipeline", run.pipeline_name());
  model.add_text("date", run.date());
  add_verdict(run, figures, model);
  add_headlines(figures, budget, model);
  model.page.set("table_budget", false);
  if (budget != nullptr) add_budget(*budget, model);
  add_accuracy(run, model);
  add_worst_segments(run, worst, model);
  add_health(run, model);
  add_timing(run, model);
  add_factors(run, model);
  add_navigation(run, model);
  add_loops(run, model);
  add_provenance(run, model);
  add_charts(run, model);
  report.packed_points = add_scene(run, model);
  return report;
}

}  // namespace traverse::report
