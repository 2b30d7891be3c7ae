#include "traverse/render/pictures/distribution.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "traverse/render/palette.hpp"

#include "pictures/note.hpp"
#include "plot/decimation.hpp"
#include "plot/number_text.hpp"
#include "plot/plot_area.hpp"
#include "plot/title_block.hpp"

namespace traverse::render {

namespace {

constexpr double kTailPercent = 99.5;    // what lies beyond may be cut off
constexpr double kLongTail = 2;          // if the axis would grow by more than this factor
constexpr double kHistogramShare = 0.6;  // of the height
constexpr double kFewestBins = 5;
constexpr double kLeastBinWidth = 6;  // pixels

std::vector<double> finite_ascending(std::span<const double> values) {
  std::vector<double> kept;
  std::copy_if(values.begin(), values.end(), std::back_inserter(kept),
               [](double value) { return std::isfinite(value); });
  std::sort(kept.begin(), kept.end());
  return kept;
}

/// From zero where nothing is negative, without a long tail.
Range shown_range(const std::vector<double>& ascending) {
  if (ascending.empty()) return {};
  Range range{std::min(0.0, ascending.front()), ascending.back()};
  const double high = percentile(ascending, kTailPercent);
  const double low = std::min(0.0, percentile(ascending, 100 - kTailPercent));
  if (high > 0 && range.high > kLongTail * high) range.high = high;
  if (low < 0 && range.low < kLongTail * low) range.low = low;
  if (!std::isfinite(range.span())) return {};
  return range.span() > 0 ? range : Range{range.low, range.low + 1};
}

struct Histogram {
  double first = 0;  // where the first bin begins
  double width = 1;
  std::vector<double> counts;
};

/// Bins of a round width near that of Freedman and Diaconis (2 IQR / cbrt(n)), beginning at a
/// multiple of it.
Histogram histogram_of(const std::vector<double>& ascending, Range range, double pixels) {
  constexpr double kUsualBins = 25;  // where half of the values are equal
  const double spread = percentile(ascending, 75) - percentile(ascending, 25);
  const double ideal = 2 * spread / std::cbrt(static_cast<double>(ascending.size()));
  Histogram histogram;
  histogram.width = nice_step_at_most(
      std::clamp(ideal > 0 ? 1.4 * ideal : range.span() / kUsualBins,
                 range.span() * kLeastBinWidth / pixels, range.span() / kFewestBins));
  histogram.first = std::floor(range.low / histogram.width) * histogram.width;
  histogram.counts.assign(
      static_cast<std::size_t>(std::floor((range.high - histogram.first) / histogram.width)) + 1,
      0);
  for (const double value : ascending) {
    const double bin = std::floor((value - histogram.first) / histogram.width);
    if (bin >= 0 && bin < static_cast<double>(histogram.counts.size())) {
      ++histogram.counts[static_cast<std::size_t>(bin)];
    }
  }
  return histogram;
}

/// The areas of the histogram and of the shares below it, over the same x axis.
std::pair<PlotArea, PlotArea> draw_both_axes(Canvas& canvas, const Rect& page, const Axis& x,
                                             const Axis& counts, const Axis& shares) {
  const double middle = page.top + kHistogramShare * page.height();
  const Rect upper{page.left, page.top, page.right, middle - canvas.sizes().gap};
  const Rect lower{page.left, middle, page.right, page.bottom};
  PlotMargins margins;
  margins.left = std::max(room_for_y_labels(canvas, counts, upper.height()),
                          room_for_y_labels(canvas, shares, lower.height()));
  PlotMargins without_x_labels = margins;
  without_x_labels.x_labels = false;
  std::pair areas{lay_out(canvas, upper, x, counts, without_x_labels),
                  lay_out(canvas, lower, x, shares, margins)};
  draw_axes(canvas, areas.first, without_x_labels);
  draw_axes(canvas, areas.second, margins);
  return areas;
}

void draw_bars(Canvas& canvas, const PlotArea& area, const Histogram& histogram) {
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    const double begin = histogram.first + static_cast<double>(i) * histogram.width;
    Rect bar{area.x_at(begin), area.y_at(histogram.counts[i]), area.x_at(begin + histogram.width),
             area.rect.bottom};
    bar.right -= std::min(1.0, 0.15 * bar.width());  // a thin gap tells the bins apart
    canvas.fill(bar, mix(canvas.theme().background, palette::kBlue, 0.75));
  }
}

void draw_shares(Canvas& canvas, const PlotArea& area, const std::vector<double>& ascending) {
  Polyline steps;
  const auto count = static_cast<double>(ascending.size());
  steps.points.push_back({area.rect.left, area.rect.bottom});
  for (std::size_t i = 0; i < ascending.size(); ++i) {
    const double x = area.x_at(ascending[i]);
    steps.points.push_back({x, area.y_at(100 * static_cast<double>(i) / count)});
    steps.points.push_back({x, area.y_at(100 * static_cast<double>(i + 1) / count)});
  }
  steps.points.push_back({std::max(area.rect.right, steps.points.back().x), area.y_at(100)});
  steps.points = decimated(steps.points);
  steps.colour = palette::kBlue;
  steps.width = canvas.sizes().line;
  canvas.add(std::move(steps), area.rect.inset(-canvas.sizes().line));
}

/// A line through both panels at a percentile, labelled at the top.
void mark_percentile(Canvas& canvas, const PlotArea& upper, const PlotArea& lower, double value,
                     const std::string& label, Colour colour) {
  const Sizes& sizes = canvas.sizes();
  const double x = upper.x_at(value);
  for (const PlotArea* area : {&upper, &lower}) {
    if (!area->x.range.contains(value)) continue;
    canvas.straight({x, area->rect.top}, {x, area->rect.bottom}, colour, 0.8 * sizes.line);
  }
  Text text = canvas.on_data(canvas.body(label, {}));
  text.weight = FontWeight::kBold;
  const double width = canvas.width_of(label, sizes.body, FontWeight::kBold);
  const double left = x - sizes.gap - width;
  const double right = x + sizes.gap;
  const bool fits_right = right + width <= upper.rect.right;
  std::vector<Point> anchors;
  for (int row = 0; row < 3; ++row) {
    const double baseline = upper.rect.top + sizes.body + row * Sizes::line_height(sizes.body);
    anchors.push_back({fits_right ? right : left, baseline});
    anchors.push_back({fits_right ? left : right, baseline});
  }
  canvas.text_at_first_free(text, anchors);
}

std::string tail_note(const std::vector<double>& ascending, const Sampled& sampled, Range shown) {
  const auto outside = static_cast<std::size_t>(std::count_if(
      ascending.begin(), ascending.end(), [&](double value) { return !shown.contains(value); }));
  if (outside == 0) return {};
  return count_text(outside) + " of " + count_text(ascending.size()) +
         " values not shown, largest " + value_text(ascending.back()) + " " + sampled.unit;
}

}  // namespace

Drawing distribution(const Sampled& sampled, const Caption& caption, const Style& style) {
  Canvas canvas(style);
  const Rect page = draw_title_block(canvas, caption, "Distribution of " + sampled.name);
  const std::vector<double> ascending = finite_ascending(sampled.values);
  if (ascending.empty()) {
    draw_note(canvas, page, "no values");
    return std::move(canvas).finish();
  }

  const Range shown = shown_range(ascending);
  const Histogram histogram = histogram_of(ascending, shown, page.width());
  const double bins_end =
      histogram.first + histogram.width * static_cast<double>(histogram.counts.size());
  const Axis x{sampled.name, sampled.unit, {histogram.first, bins_end}};
  const double most = *std::max_element(histogram.counts.begin(), histogram.counts.end());
  const Axis counts{"values in each " + value_text(histogram.width, 1) + " " + sampled.unit,
                    "",
                    {0, 1.08 * std::max(1.0, most)},
                    true};
  const Axis shares{"share of values up to here", "%", {0, 103}};

  const auto [upper, lower] = draw_both_axes(canvas, page, x, counts, shares);
  draw_bars(canvas, upper, histogram);
  draw_shares(canvas, lower, ascending);
  for (const auto& [percent, name, colour] : {std::tuple{50.0, "median ", palette::kVermillion},
                                              {95.0, "95 % below ", palette::kOrange}}) {
    const double value = percentile(ascending, percent);
    mark_percentile(canvas, upper, lower, value, name + value_text(value) + " " + sampled.unit,
                    colour);
  }
  canvas.text(canvas.note(tail_note(ascending, sampled, x.range),
                          {upper.rect.right, header_baseline(canvas, upper)},
                          HorizontalAlign::kRight));
  return std::move(canvas).finish();
}

}  // namespace traverse::render
