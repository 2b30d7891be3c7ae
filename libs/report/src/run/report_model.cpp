#include "run/report_model.hpp"

#include "charts/charts.hpp"
#include "page/scene.hpp"
#include "sections/report_sections.hpp"

namespace traverse::report {

ReportModel make_model(const ReportInput& input) {
  const RunData& run = input.run;
  ReportModel report;
  Model& model = report.model;
  model.json["schema"] = "traverse/report/1";
  model.add_text("recording", run.recording_name());
  model.add_text("pipeline", run.pipeline_name());
  model.add_text("date", run.date());
  model.add_text("program_version", run.record.at("program").at("version").get<std::string>());
  Json charts = Json::array();
  for (const ReportSection& section : report_sections()) {
    if (!section.applies(run)) continue;
    report.sections.push_back(&section);
    section.fill(input, model);
    if (section.chart != nullptr) section.chart(run, charts);
  }
  model.json["charts"] = std::move(charts);
  add_poses(run, model);
  report.packed_points = add_scene(run, model);
  return report;
}

}  // namespace traverse::report
