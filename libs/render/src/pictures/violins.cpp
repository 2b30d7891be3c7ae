#include "traverse/render/pictures/violins.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "traverse/render/palette.hpp"
#include "traverse/render/plot/range.hpp"

#include "pictures/note.hpp"
#include "plot/number_text.hpp"
#include "plot/plot_area.hpp"
#include "plot/title_block.hpp"

namespace traverse::render {

namespace {

constexpr double kViolinTailPercent = 99.5;  // what lies beyond may be cut off
constexpr double kLongViolinTail = 1.5;      // if the axis would grow by more than this factor
constexpr int kSteps = 240;                  // of the outline
constexpr double kHalfViolin = 0.42;         // of the row's height
constexpr double kHalfBox = 0.10;
constexpr std::size_t kMostKernels = 4000;

std::vector<double> finite_ascending(std::span<const double> values) {
  std::vector<double> kept;
  std::copy_if(values.begin(), values.end(), std::back_inserter(kept),
               [](double value) { return std::isfinite(value); });
  std::sort(kept.begin(), kept.end());
  return kept;
}

Range shown_range(const std::vector<double>& ascending) {
  const double high = percentile(ascending, kViolinTailPercent);
  const double most =
      ascending.back() > kLongViolinTail * high && high > 0 ? high : ascending.back();
  const double least = std::min(0.0, ascending.front());
  return most > least ? Range{least, 1.02 * most} : Range{least, least + 1};
}

/// Silverman's width of the kernels: 0.9 min(sigma, IQR / 1.34) n^(-1/5).
double kernel_width(const std::vector<double>& ascending, Range shown) {
  const auto n = static_cast<double>(ascending.size());
  double mean = 0;
  for (const double value : ascending) mean += value / n;
  double variance = 0;
  for (const double value : ascending) variance += (value - mean) * (value - mean) / n;
  const double spread = (percentile(ascending, 75) - percentile(ascending, 25)) / 1.34;
  const double sigma = spread > 0 ? std::min(std::sqrt(variance), spread) : std::sqrt(variance);
  return std::max(0.9 * sigma * std::pow(n, -0.2), shown.span() / kSteps);
}

/// Density along the axis, the largest 1.
std::vector<double> density_along(const std::vector<double>& ascending, Range shown) {
  const double width = kernel_width(ascending, shown);
  const std::size_t stride = 1 + ascending.size() / kMostKernels;
  std::vector<double> density(kSteps + 1, 0);
  for (int step = 0; step <= kSteps; ++step) {
    const double x = shown.low + shown.span() * step / kSteps;
    for (std::size_t i = 0; i < ascending.size(); i += stride) {
      const double z = (x - ascending[i]) / width;
      density[static_cast<std::size_t>(step)] += std::exp(-0.5 * z * z);
    }
  }
  const double most = *std::max_element(density.begin(), density.end());
  for (double& value : density) value /= most;
  return density;
}

void draw_violin(Canvas& canvas, const PlotArea& area, const std::vector<double>& ascending) {
  const std::vector<double> density = density_along(ascending, area.x.range);
  const double middle = area.rect.centre().y;
  const double half = kHalfViolin * area.rect.height();
  const Colour fill = mix(canvas.theme().background, palette::kBlue, 0.35);
  // A strip a step, since only convex areas can be filled; they share corners exactly.
  Polyline outline;
  std::vector<Point> lower;
  for (int step = 0; step <= kSteps; ++step) {
    const double x = area.rect.left + area.rect.width() * step / kSteps;
    const double reach = half * density[static_cast<std::size_t>(step)];
    if (step > 0) {
      const Point above = outline.points.back();
      const Point below = lower.back();
      canvas.add(Polygon{{above, {x, middle - reach}, {x, middle + reach}, below}, fill, 1},
                 area.rect);
    }
    outline.points.push_back({x, middle - reach});
    lower.push_back({x, middle + reach});
  }
  outline.points.insert(outline.points.end(), lower.rbegin(), lower.rend());
  outline.closed = true;
  outline.colour = palette::kBlue;
  outline.width = canvas.sizes().hairline;
  canvas.add(std::move(outline), area.rect);
}

void draw_box(Canvas& canvas, const PlotArea& area, const std::vector<double>& ascending) {
  const double middle = area.rect.centre().y;
  const double half = kHalfBox * area.rect.height();
  const auto at = [&](double percent) { return area.x_at(percentile(ascending, percent)); };
  const Colour ink = canvas.theme().text;
  const double line = canvas.sizes().line;
  canvas.straight({at(5), middle}, {at(95), middle}, ink, 0.75 * line);
  for (const double percent : {5.0, 95.0}) {
    canvas.straight({at(percent), middle - half}, {at(percent), middle + half}, ink, 0.75 * line);
  }
  canvas.fill({at(25), middle - half, at(75), middle + half}, ink);
  canvas.straight({at(50), middle - 2 * half}, {at(50), middle + 2 * half}, palette::kVermillion,
                  2 * line);
}

std::string summary(const Sampled& sampled, const std::vector<double>& ascending) {
  const auto value = [&](double percent) { return value_text(percentile(ascending, percent)); };
  return "median " + value(50) + ", quartiles " + value(25) + " and " + value(75) +
         ", 5 and 95 % " + value(5) + " and " + value(95) + " " + sampled.unit + ", " +
         count_text(ascending.size()) + " values";
}

void draw_row(Canvas& canvas, const Rect& outer, const Sampled& sampled) {
  const std::vector<double> ascending = finite_ascending(sampled.values);
  if (ascending.empty()) {
    draw_note(canvas, outer, sampled.name + ": no values");
    return;
  }
  const Axis x{sampled.name, sampled.unit, shown_range(ascending)};
  const Axis y{"", "", {0, 1}};
  PlotArea area = lay_out(canvas, outer, x, y);
  area.y_ticks = {};
  draw_axes(canvas, area);
  draw_violin(canvas, area, ascending);
  draw_box(canvas, area, ascending);
  canvas.text(canvas.note(summary(sampled, ascending),
                          {area.rect.right, header_baseline(canvas, area)},
                          HorizontalAlign::kRight));
}

}  // namespace

Drawing violins(std::span<const Sampled> distributions, const Caption& caption,
                const Style& style) {
  Canvas canvas(style);
  const Rect page = draw_title_block(canvas, caption, "Distributions");
  const double height =
      page.height() / static_cast<double>(std::max<std::size_t>(1, distributions.size()));
  for (std::size_t k = 0; k < distributions.size(); ++k) {
    const double top = page.top + static_cast<double>(k) * height;
    draw_row(canvas, {page.left, top, page.right, top + height - canvas.sizes().gap},
             distributions[k]);
  }
  if (distributions.empty()) draw_note(canvas, page, "no values");
  return std::move(canvas).finish();
}

}  // namespace traverse::render
