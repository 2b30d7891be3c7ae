#include "traverse/report/run_report.hpp"

#include <system_error>
#include <vector>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/work_folder.hpp"
#include "traverse/pipeline/run_folder.hpp"

#include "figures/figures.hpp"
#include "page/page.hpp"
#include "run/report_model.hpp"
#include "sections/budget_check.hpp"

namespace traverse::report {

namespace {

void move_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::error_code failure;
  std::filesystem::rename(from, to, failure);
  if (failure) throw files::OutputError(to, failure.message());
}

/// The page last: whoever sees it sees what belongs to it.
void move_into_place(const pipeline::RunFolder& made, const pipeline::RunFolder& run) {
  if (std::filesystem::exists(made.images())) {
    files::make_writable_folder(run.images());
    for (const auto& picture : std::filesystem::directory_iterator(made.images())) {
      move_file(picture.path(), run.images() / picture.path().filename());
    }
  }
  move_file(made.report_json(), run.report_json());
  move_file(made.report(), run.report());
}

}  // namespace

std::optional<BudgetResult> write_run_report(const std::filesystem::path& run_folder,
                                             const std::filesystem::path& templates,
                                             const RunReportOptions& options) {
  RunData run = read_run(run_folder, pipeline::RunPart::kAll);
  if (!options.folder_on_page.empty()) run.folder = {options.folder_on_page};
  const std::vector<RunFigure> figures = run_figures(run);
  std::optional<BudgetResult> budget;
  if (options.budget) budget = check_figures(*options.budget, figures);
  if (options.is_private || run.is_private() || (budget && budget->is_private)) {
    make_private(run, run.folder.path);
  }

  const evaluation::WorstSegments worst =
      evaluation::worst_segments(run.evaluation, run.frames.column("residual_rms_m"));
  const ReportInput input{run, figures, worst, budget ? &*budget : nullptr};
  const pipeline::RunFolder files{run_folder};
  files::WorkFolder work(files.report_work(), files.report());
  work.clear();
  const pipeline::RunFolder made{work.path()};
  std::vector<Figure> pictures;
  if (options.pictures) pictures = draw_figures(input, options, made.images());

  ReportModel report = make_model(input);
  const std::string page = make_page(report, pictures, templates);
  files::write_text(made.report_json(), script_text(report.model.json) + "\n");
  files::write_text(made.report(), page);
  move_into_place(made, files);
  if (options.exports) page::export_tables(report.model.tables, *options.exports);
  return budget;
}

}  // namespace traverse::report
