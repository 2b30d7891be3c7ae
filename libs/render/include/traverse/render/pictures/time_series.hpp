#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "traverse/render/caption.hpp"
#include "traverse/render/drawing.hpp"
#include "traverse/render/plot/range.hpp"
#include "traverse/render/style.hpp"

namespace traverse::render {

/// One line. A value that is not finite, and a step in x of more than five times the median, is a
/// gap in it.
struct Series {
  std::string name;           ///< for the legend; may be empty in a panel of one series
  std::span<const double> x;  ///< ascending
  std::span<const double> y;  ///< as many
};

/// A value to compare a panel's lines with.
struct Level {
  double value = 0;
  std::string label;  ///< "median 9.8 ms"
};

struct Panel {
  std::string name;  ///< "APE"
  std::string unit;  ///< "m"; empty for counts
  std::vector<Series> series;
  std::optional<Level> level;
};

/// Stretches of x that are set apart, in all panels.
struct ShadedSpans {
  std::string name;  ///< "degenerate"
  std::vector<Range> spans;
};

/// Series over a common axis, in panels one below the other.
struct TimeSeries {
  std::string x_name = "time";
  std::string x_unit = "s";
  std::vector<Panel> panels;
  std::vector<ShadedSpans> shaded;  ///< two kinds at most can be told apart
};

/// Long series are thinned so that the peaks stay. Values that are all positive have their axis
/// begin at zero. \throws std::invalid_argument if a series has not one y for each x.
Drawing time_series(const TimeSeries& data, const Caption& caption, const Style& style);

}  // namespace traverse::render
