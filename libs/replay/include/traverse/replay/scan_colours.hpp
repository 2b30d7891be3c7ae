#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "traverse/render/colour.hpp"
#include "traverse/replay/shown.hpp"

namespace traverse::replay {

/// What the points of a scan can be coloured by.
enum class ScanColour { kClass, kRing, kTime, kHeight, kIntensity, kResidual };

inline constexpr std::array<std::pair<std::string_view, ScanColour>, 6> kScanColourNames{
    {{"class", ScanColour::kClass},
     {"ring", ScanColour::kRing},
     {"time", ScanColour::kTime},
     {"height", ScanColour::kHeight},
     {"intensity", ScanColour::kIntensity},
     {"residual", ScanColour::kResidual}}};
std::string_view name_of(ScanColour colour);
std::optional<ScanColour> scan_colour_named(std::string_view name);

/// Residuals of this size take the ends of the diverging scale, metres.
inline constexpr double kResidualScale = 0.1;

/// What colours mean.
struct ColourLegend {
  std::string title;  ///< with the unit: "height [m], 2nd to 98th percentile"
  std::vector<render::Colour> samples;
  /// One for each sample, or for the samples' ends.
  std::vector<std::string> labels;
};

struct ScanColours {
  std::vector<render::Colour> colours;  ///< one a point
  ColourLegend legend;
};

/// Colours for the points of a scan. Ranges end at the 2nd and 98th percentile. What the scan does
/// not hold is told by the legend, and the points are grey; with kResidual they are grey too, for
/// residuals belong to the matched points (residual_colour()).
ScanColours colours_of(const ShownScan& scan, ScanColour by);

/// Of a matched point: blue behind the plane, white on it, orange before it; lines have no sign.
render::Colour residual_colour(double residual_m);

}  // namespace traverse::replay
