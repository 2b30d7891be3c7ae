#pragma once

#include <functional>
#include <string>
#include <vector>

#include "run_data.hpp"

namespace traverse::report {

/// One picture of the report, drawn for light and for dark pages.
struct Figure {
  std::string name;     ///< file name without ending and anchor: "trajectory-above"
  std::string section;  ///< where it stands: "trajectory", "error", "map", "health", "timing"
  std::string caption;  ///< below it, one sentence
  std::string light_png;
  std::string dark_png;
};

/// Draws every picture that the run has data for and writes them to images/NAME.png and
/// images/NAME_dark.png. \throws files::OutputError
std::vector<Figure> draw_figures(const RunData& run,
                                 const std::function<void(const std::string&)>& picture_drawn);

}  // namespace traverse::report
