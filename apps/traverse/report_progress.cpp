#include "report_progress.hpp"

#include <cstddef>
#include <string>

#include "progress_bar.hpp"

namespace traverse::app {

std::optional<report::BudgetResult> write_report_with_progress(
    const std::filesystem::path& run_folder, const std::filesystem::path& templates,
    report::RunReportOptions options) {
  ProgressBar bar("report", 0, "pictures");
  std::size_t pictures = 0;
  options.picture_drawn = [&](const std::string&) { bar.update(++pictures); };
  auto budget = report::write_run_report(run_folder, templates, options);
  if (options.pictures) bar.finish();
  return budget;
}

}  // namespace traverse::app
