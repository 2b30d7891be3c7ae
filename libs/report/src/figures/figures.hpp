#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "traverse/report/run_report.hpp"

#include "run/report_input.hpp"

namespace traverse::report {

/// One picture of the report, drawn for light and for dark pages.
struct Figure {
  std::string name;     ///< file name without ending and anchor: "trajectory-above"
  std::string section;  ///< where it stands: {{#figures_SECTION}} of a template
  std::string caption;  ///< below it, one sentence
  /// The view that shows the same interactively, in whose absence it is seen: "3d", "charts", "".
  std::string replaced_by;
  std::string light;  ///< data URIs of both, as the page holds them
  std::string dark;
};

/// Draws every picture that the run has data for and writes them to `images` as NAME.png and
/// NAME_dark.png; those without point clouds also as NAME.svg and NAME.pdf, the others for print,
/// if that is asked for. \throws files::OutputError; ReportStopped
std::vector<Figure> draw_figures(const ReportInput& input, const RunReportOptions& options,
                                 const std::filesystem::path& images);

}  // namespace traverse::report
