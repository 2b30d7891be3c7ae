#include "traverse/report/run_report.hpp"

#include <vector>

#include "traverse/files/atomic_file.hpp"
#include "traverse/pipeline/run_folder.hpp"

#include "budget_check.hpp"
#include "exports.hpp"
#include "figures.hpp"
#include "page.hpp"
#include "report_model.hpp"

namespace traverse::report {

std::optional<BudgetResult> write_run_report(const std::filesystem::path& run_folder,
                                             const std::filesystem::path& templates,
                                             const RunReportOptions& options) {
  const RunData run = read_run(run_folder, pipeline::RunPart::kAll);
  const std::vector<RunFigure> figures = run_figures(run);
  std::optional<BudgetResult> budget;
  if (options.budget) budget = check_figures(*options.budget, figures);

  const evaluation::WorstSegments worst =
      evaluation::worst_segments(run.evaluation, run.frames.column("residual_rms_m"));
  std::vector<Figure> pictures;
  if (options.pictures) pictures = draw_figures(run, worst, options);

  ReportModel report = make_model(run, figures, worst, budget ? &*budget : nullptr);
  const std::string page = make_page(report.model, report.packed_points, pictures, templates);
  const pipeline::RunFolder files{run_folder};
  files::write_text(files.report_json(), text_for_script(report.model.json) + "\n");
  files::write_text(files.report(), page);
  if (options.exports) export_tables(report.model.json.at("tables"), *options.exports);
  return budget;
}

}  // namespace traverse::report
