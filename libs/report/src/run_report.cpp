#include "traverse/report/run_report.hpp"

#include <vector>

#include "traverse/files/atomic_file.hpp"
#include "traverse/pipeline/run_folder.hpp"

#include "figures.hpp"
#include "page.hpp"
#include "run_data.hpp"

namespace traverse::report {

void write_run_report(const std::filesystem::path& run_folder,
                      const std::filesystem::path& templates, const RunReportOptions& options) {
  const RunData run = read_run(run_folder);
  const std::vector<Figure> figures = draw_figures(run, options.picture_drawn);
  files::write_text(pipeline::RunFolder{run_folder}.report(), make_page(run, figures, templates));
}

}  // namespace traverse::report
