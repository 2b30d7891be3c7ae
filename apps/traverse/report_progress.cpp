#include "report_progress.hpp"

#include <cstddef>
#include <string>

#include "traverse/report/run_report.hpp"

#include "progress_bar.hpp"

namespace traverse::app {

void write_report_with_progress(const std::filesystem::path& run_folder,
                                const std::filesystem::path& templates) {
  ProgressBar bar("report", 0, "pictures");
  std::size_t pictures = 0;
  report::RunReportOptions options;
  options.picture_drawn = [&](const std::string&) { bar.update(++pictures); };
  report::write_run_report(run_folder, templates, options);
  bar.finish();
}

}  // namespace traverse::app
