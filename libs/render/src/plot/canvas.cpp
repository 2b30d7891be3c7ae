#include "plot/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace traverse::render {

namespace {

constexpr double kUsualArea = 1600.0 * 1000.0;
constexpr double kLeastTextSize = 9;

}  // namespace

Sizes Sizes::for_picture(int width, int height) {
  const double scale =
      std::sqrt(static_cast<double>(width) * static_cast<double>(height) / kUsualArea);
  const double text = scale >= 1 ? scale : std::sqrt(scale);
  Sizes sizes;
  sizes.title = std::max(kLeastTextSize * 1.3, sizes.title * text);
  sizes.body = std::max(kLeastTextSize, sizes.body * text);
  sizes.tick = std::max(kLeastTextSize, sizes.tick * text);
  sizes.margin *= scale >= 1 ? scale : std::pow(scale, 0.8);
  sizes.gap *= text;
  sizes.line *= text;
  sizes.hairline = std::max(1.0, std::round(scale));
  return sizes;
}

Canvas::Canvas(const Style& style)
    : style_(style), sizes_(Sizes::for_picture(style.width, style.height)) {
  drawing_.width = style.width;
  drawing_.height = style.height;
  drawing_.background = style.theme.background;
}

Rect Canvas::page() const {
  return {0, 0, static_cast<double>(style_.width), static_cast<double>(style_.height)};
}

void Canvas::add(Shape shape, std::optional<Rect> clip) {
  drawing_.items.push_back({std::move(shape), clip});
}

void Canvas::fill(const Rect& rect, Colour colour, double opacity) {
  if (rect.empty()) return;
  add(Polygon{{{rect.left, rect.top},
               {rect.right, rect.top},
               {rect.right, rect.bottom},
               {rect.left, rect.bottom}},
              colour,
              opacity});
}

void Canvas::straight(Point from, Point to, Colour colour, double width) {
  const auto onto_pixels = [&](double position) {
    return std::floor(position - width / 2 + 0.5) + width / 2;
  };
  if (from.x == to.x) from.x = to.x = onto_pixels(from.x);
  if (from.y == to.y) from.y = to.y = onto_pixels(from.y);
  Polyline line;
  line.points = {from, to};
  line.colour = colour;
  line.width = width;
  line.cap = LineCap::kButt;
  add(std::move(line));
}

bool Canvas::is_free(const Rect& rect) const {
  return std::none_of(taken_.begin(), taken_.end(),
                      [&](const Rect& taken) { return taken.overlaps(rect); });
}

Text Canvas::body(std::string utf8, Point anchor, HorizontalAlign align) const {
  return {std::move(utf8), anchor, sizes_.body, FontWeight::kRegular, align, theme().text, {}};
}

Text Canvas::note(std::string utf8, Point anchor, HorizontalAlign align) const {
  return {std::move(utf8), anchor, sizes_.tick, FontWeight::kRegular, align, theme().muted, {}};
}

Text Canvas::on_data(Text text) const {
  text.halo = theme().background;
  return text;
}

bool Canvas::text(const Text& text) {
  if (text.utf8.empty()) return false;
  const Rect box = measure_.box(text);
  if (box.empty() || !page().contains(box) || !is_free(box)) return false;
  reserve(box);
  drawing_.texts.push_back(text);
  return true;
}

bool Canvas::text_at_first_free(Text text, const std::vector<Point>& anchors) {
  return std::any_of(anchors.begin(), anchors.end(), [&](Point anchor) {
    text.anchor = anchor;
    return this->text(text);
  });
}

}  // namespace traverse::render
