#include "traverse/report/evaluation_pictures.hpp"

#include "traverse/pipeline/provenance.hpp"
#include "traverse/report/run_report.hpp"

#include "figures/figure_maker.hpp"
#include "figures/trajectory_figures.hpp"
#include "run/run_data.hpp"
#include "sections/error_figures.hpp"

namespace traverse::report {

namespace {

/// Poses that go by number, a second apart: what is drawn over time is drawn over them.
geometry::Trajectory with_stamps(const geometry::Trajectory& path) {
  if (path.is_stamped()) return path;
  geometry::Trajectory stamped;
  for (std::size_t i = 0; i < path.size(); ++i) {
    stamped.push_back(geometry::Stamp::from_seconds(static_cast<double>(i)), path.pose(i));
  }
  return stamped;
}

}  // namespace

std::size_t draw_evaluation(const ComparedTrajectories& compared,
                            const std::filesystem::path& folder) {
  RunData run;
  run.estimate = with_stamps(compared.estimate);
  run.reference = with_stamps(compared.reference);
  run.evaluation = compared.evaluation;
  const bool by_number = !compared.estimate.is_stamped();
  evaluation::Comparison& comparison = *run.evaluation.comparison;
  if (comparison.stamps.empty()) {
    for (const auto& match : comparison.association.matches) {
      comparison.stamps.push_back(run.estimate.stamp(match.estimate));
    }
  }
  run.record = {{"recording", {{"name", compared.reference_name}}},
                {"pipeline", compared.estimate_name + (by_number ? ", seconds are numbers" : "")},
                {"started_utc", pipeline::utc_now()},
                {"map", nlohmann::json::object()}};
  FigureMaker maker(run, RunReportOptions{}, folder);
  add_trajectory_figures(run, maker);
  add_error_figures(run, maker);
  return maker.take().size();
}

}  // namespace traverse::report
