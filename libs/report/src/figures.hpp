#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "run_data.hpp"
#include "worst_segments.hpp"

namespace traverse::report {

/// Where a picture may stand on the page.
inline constexpr std::array<const char*, 9> kFigureSections{
    "trajectory", "loops", "error", "association", "worst", "kitti", "map", "health", "timing"};

/// One picture of the report, drawn for light and for dark pages.
struct Figure {
  std::string name;     ///< file name without ending and anchor: "trajectory-above"
  std::string section;  ///< where it stands, one of kFigureSections
  std::string caption;  ///< below it, one sentence
  /// The view that shows the same interactively, in whose absence it is seen: "3d", "charts", "".
  std::string replaced_by;
  std::string light;  ///< data URIs of both, as the page holds them
  std::string dark;
};

/// Draws every picture that the run has data for, `width` pixels wide, and writes them to
/// images/NAME.png and images/NAME_dark.png; those without point clouds also to images/NAME.svg and
/// images/NAME.pdf. \throws files::OutputError
std::vector<Figure> draw_figures(const RunData& run, const WorstSegments& worst, int width,
                                 const std::function<void(const std::string&)>& picture_drawn);

}  // namespace traverse::report
