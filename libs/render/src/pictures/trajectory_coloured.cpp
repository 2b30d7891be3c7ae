#include "traverse/render/pictures/trajectory_coloured.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "pictures/trajectory_lines.hpp"
#include "plot/colour_bar.hpp"
#include "plot/legend.hpp"
#include "plot/markers.hpp"
#include "plot/number_text.hpp"
#include "plot/occupancy.hpp"
#include "plot/path.hpp"
#include "plot/scale_bar.hpp"
#include "plot/title_block.hpp"

namespace traverse::render {

namespace {

std::vector<Colour> colours_of(const Path& path, const PoseValues& values, const ColourScale& scale,
                               Colour unknown) {
  std::vector<Colour> colours;
  colours.reserve(path.poses.size());
  for (const std::size_t pose : path.poses) {
    const double value = values.values[pose];
    colours.push_back(std::isfinite(value) ? scale(value) : unknown);
  }
  return colours;
}

/// The coloured line on a wider one in a neutral colour: yellow on white would not be seen.
void draw_coloured(Canvas& canvas, const PlotArea& area, const std::vector<Point>& points,
                   std::vector<Colour> colours) {
  const double width = 3.2 * canvas.sizes().line;
  Polyline casing;
  casing.points = points;
  casing.colour = canvas.theme().axis;
  casing.width = width + 1.2 * canvas.sizes().line;
  canvas.add(std::move(casing), area.rect);
  Polyline line;
  line.points = points;
  line.colours = std::move(colours);
  line.width = width;
  canvas.add(std::move(line), area.rect);
}

/// The index into `path` of the pose with the value of the largest size.
std::optional<std::size_t> worst(const Path& path, const PoseValues& values) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    if (!path.positions[i].allFinite() || !std::isfinite(values.values[path.poses[i]])) continue;
    if (!found ||
        std::abs(values.values[path.poses[i]]) > std::abs(values.values[path.poses[*found]])) {
      found = i;
    }
  }
  return found;
}

void draw_ring(Canvas& canvas, Point at, double radius) {
  Polyline ring;
  for (int i = 0; i < 32; ++i) {
    const double angle = 2 * std::numbers::pi * i / 32;
    ring.points.push_back(at + radius * Point{std::cos(angle), std::sin(angle)});
  }
  ring.closed = true;
  ring.colour = canvas.theme().text;
  ring.width = canvas.sizes().line;
  canvas.add(std::move(ring));
}

/// Rings `at` and writes `text` beside it, where it hides the least of the line.
void label_worst(Canvas& canvas, const PlotArea& area, Point at, const std::string& text,
                 const Occupancy& occupancy) {
  const Sizes& sizes = canvas.sizes();
  draw_ring(canvas, at, 5.5 * sizes.line);
  Text label = canvas.on_data(canvas.body(text, {}));
  label.weight = FontWeight::kBold;
  const double away = 7 * sizes.line;
  const double left = at.x - away - canvas.width_of(text, sizes.body, FontWeight::kBold);
  const double right = at.x + away;
  const double above = at.y - away;
  const double below = at.y + away + 0.7 * sizes.body;
  std::vector<Point> anchors{{right, above}, {right, below}, {left, above}, {left, below}};
  const auto hidden = [&](Point anchor) {
    label.anchor = anchor;
    const Rect box = canvas.measure().box(label);
    return area.rect.contains(box) ? occupancy.share(box) : 2;
  };
  std::stable_sort(anchors.begin(), anchors.end(),
                   [&](Point a, Point b) { return hidden(a) < hidden(b); });
  canvas.text_at_first_free(label, anchors);
}

}  // namespace

Drawing trajectory_coloured(const geometry::Trajectory& estimate, const PoseValues& values,
                            const geometry::Trajectory* reference, const Caption& caption,
                            const Style& style) {
  if (values.values.size() != estimate.size()) {
    throw std::invalid_argument("a coloured trajectory needs one value a pose");
  }
  Canvas canvas(style);
  const Sizes& sizes = canvas.sizes();
  const Path path = path_of(estimate);
  const Path reference_path = reference != nullptr ? path_of(*reference) : Path{};
  const ColourBar bar{colour_scale(values.values, values.map), values.name, values.unit};

  const Rect page = draw_title_block(canvas, caption, "Trajectory coloured by error");
  Rect outer = page;
  outer.right -= colour_bar_width(canvas, bar) + 2 * sizes.gap;
  std::vector<LegendEntry> legend;
  if (!reference_path.empty()) {
    legend.push_back({"reference", style.theme.reference, Sample::kDashedLine});
  }
  if (!path.empty()) {
    legend.push_back({"start", style.theme.text, Sample::kStart});
    legend.push_back({"end", style.theme.text, Sample::kEnd});
  }
  outer = draw_legend_above(canvas, legend, outer, "y [m]");
  const PlotArea area = lay_out_from_above(canvas, outer, {&path, &reference_path});
  draw_axes(canvas, area);
  draw_colour_bar(canvas, bar,
                  {outer.right + 2 * sizes.gap, page.top, page.right, area.rect.bottom});

  const std::vector<Point> line = seen_from_above(path, area);
  Occupancy occupancy(style.width, style.height);
  occupancy.add_line(line);
  // Here the colour is what matters: where the two agree, the reference hides below.
  draw_reference(canvas, area, seen_from_above(reference_path, area));
  draw_coloured(canvas, area, line, colours_of(path, values, bar.scale, style.theme.other));
  draw_path_marks(canvas, line, path, style.theme.text);
  if (const auto index = worst(path, values)) {
    const double value = values.values[path.poses[*index]];
    label_worst(canvas, area, line[*index], "max " + value_text(value) + " " + values.unit,
                occupancy);
  }
  draw_scale_bar(canvas, area, occupancy);
  return std::move(canvas).finish();
}

}  // namespace traverse::render
