#include "pictures/trajectory_lines.hpp"

#include <optional>
#include <utility>

#include "plot/legend.hpp"

namespace traverse::render {

namespace {

constexpr double kLeastExtent = 1;  // metres: a vehicle that stands still is not magnified
constexpr double kLineRoom = 0.06;  // of the range, on each side

Range with_room(Range range) { return range.at_least(kLeastExtent).padded(kLineRoom); }

}  // namespace

PlotArea lay_out_from_above(const Canvas& canvas, const Rect& outer,
                            const std::vector<const Path*>& paths) {
  std::optional<Bounds> bounds;
  for (const Path* path : paths) {
    if (path->empty()) continue;
    const Bounds more = bounds_of(*path);
    bounds = bounds ? Bounds{bounds->x.joined(more.x), bounds->y.joined(more.y),
                             bounds->z.joined(more.z)}
                    : more;
  }
  const Bounds shown = bounds.value_or(Bounds{});
  return lay_out_equal(canvas, outer, {"x", "m", with_room(shown.x)},
                       {"y", "m", with_room(shown.y)});
}

void draw_estimate(Canvas& canvas, const PlotArea& area, std::vector<Point> line, Colour colour) {
  Polyline solid;
  solid.points = std::move(line);
  solid.colour = colour;
  solid.width = 1.3 * canvas.sizes().line;
  canvas.add(std::move(solid), area.rect);
}

void draw_reference(Canvas& canvas, const PlotArea& area, std::vector<Point> line) {
  Polyline dashes;
  dashes.points = std::move(line);
  dashes.colour = canvas.theme().reference;
  dashes.width = 0.8 * canvas.sizes().line;
  dashes.dashes = reference_dashes(canvas.sizes());
  dashes.cap = LineCap::kButt;
  canvas.add(std::move(dashes), area.rect);
}

}  // namespace traverse::render
