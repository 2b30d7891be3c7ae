#include "figures/figures.hpp"

#include "figures/figure_maker.hpp"
#include "sections/report_sections.hpp"

namespace traverse::report {

std::vector<Figure> draw_figures(const ReportInput& input, const RunReportOptions& options,
                                 const std::filesystem::path& images) {
  FigureMaker maker(input.run, options, images);
  for (const ReportSection& section : report_sections()) {
    if (section.draw != nullptr && section.applies(input.run)) section.draw(input, maker);
  }
  return maker.take();
}

}  // namespace traverse::report
