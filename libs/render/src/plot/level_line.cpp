#include "plot/level_line.hpp"

#include <cmath>
#include <utility>

#include "plot/legend.hpp"

namespace traverse::render {

void draw_level_line(Canvas& canvas, const PlotArea& area, double value) {
  if (!std::isfinite(value)) return;
  Polyline line;
  line.points = {{area.rect.left, area.y_at(value)}, {area.rect.right, area.y_at(value)}};
  line.colour = canvas.theme().text;
  line.width = 0.6 * canvas.sizes().line;
  line.dashes = reference_dashes(canvas.sizes());
  line.cap = LineCap::kButt;
  canvas.add(std::move(line), area.rect);
}

}  // namespace traverse::render
