#include "traverse/render/vector_file.hpp"

#include <algorithm>
#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <functional>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "traverse/render/renderer.hpp"

#include "polyline_pieces.hpp"
#include "text_measure.hpp"

namespace traverse::render {

namespace {

constexpr double kHaloWidth = 0.28;  // of the text's size, both sides together
constexpr double kTextHaloOpacity = 0.85;
constexpr double kPointsAPixel = 72.0 / 96.0;

void set_colour(cairo_t* c, Colour colour, double opacity = 1) {
  cairo_set_source_rgba(c, colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0, opacity);
}

void trace(cairo_t* c, const std::vector<LinePiece::Vertex>& vertices, bool closed) {
  cairo_new_path(c);
  for (const auto& vertex : vertices) cairo_line_to(c, vertex.point.x, vertex.point.y);
  if (closed) cairo_close_path(c);
}

void draw(cairo_t* c, const Polyline& line) {
  cairo_set_line_width(c, line.width);
  cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(c, line.cap == LineCap::kRound ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
  for (const LinePiece& whole : continuous_pieces(line)) {
    for (const LinePiece& piece : dashed(whole, line.dashes)) {
      if (line.colours.empty()) {
        set_colour(c, line.colour);
        trace(c, piece.vertices, piece.closed);
        cairo_stroke(c);
        continue;
      }
      for (std::size_t i = 1; i < piece.vertices.size(); ++i) {  // a colour a stretch
        set_colour(c, piece.vertices[i].colour);
        trace(c, {piece.vertices[i - 1], piece.vertices[i]}, false);
        cairo_stroke(c);
      }
    }
  }
}

void draw(cairo_t* c, const Polygon& polygon) {
  set_colour(c, polygon.fill, polygon.opacity);
  cairo_new_path(c);
  for (const Point& corner : polygon.corners) cairo_line_to(c, corner.x, corner.y);
  cairo_close_path(c);
  cairo_fill(c);
}

void draw(cairo_t* c, const Disc& disc) {
  set_colour(c, disc.fill, disc.opacity);
  cairo_new_path(c);
  cairo_arc(c, disc.centre.x, disc.centre.y, disc.radius, 0, 2 * std::numbers::pi);
  cairo_fill(c);
}

void draw(cairo_t* /*c*/, const PointCloud& /*cloud*/) {
  throw std::invalid_argument("a point cloud is no vector graphic");
}

void draw(cairo_t* c, const Text& text) {
  const std::string utf8 = printable(text.utf8);
  cairo_select_font_face(
      c, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
      text.weight == FontWeight::kBold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(c, text.size);
  cairo_text_extents_t extents;
  cairo_text_extents(c, utf8.c_str(), &extents);
  const double share = text.align == HorizontalAlign::kLeft     ? 0.0
                       : text.align == HorizontalAlign::kCentre ? 0.5
                                                                : 1.0;
  const double left = text.anchor.x - share * extents.width - extents.x_bearing;
  if (text.halo) {
    cairo_move_to(c, left, text.anchor.y);
    cairo_text_path(c, utf8.c_str());
    set_colour(c, *text.halo, kTextHaloOpacity);
    cairo_set_line_width(c, kHaloWidth * text.size);
    cairo_stroke(c);
  }
  set_colour(c, text.colour);
  cairo_move_to(c, left, text.anchor.y);
  cairo_show_text(c, utf8.c_str());
}

void draw(cairo_t* c, const Drawing& drawing) {
  set_colour(c, drawing.background);
  cairo_paint(c);
  for (const Drawing::Item& item : drawing.items) {
    cairo_save(c);
    if (item.clip) {
      cairo_rectangle(c, item.clip->left, item.clip->top, item.clip->width(), item.clip->height());
      cairo_clip(c);
    }
    std::visit([&](const auto& shape) { draw(c, shape); }, item.shape);
    cairo_restore(c);
  }
  for (const Text& text : drawing.texts) draw(c, text);
}

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int size) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), size);
  return CAIRO_STATUS_SUCCESS;
}

using MakeSurface = cairo_surface_t* (*)(cairo_write_func_t, void*, double, double);

std::string encode(const Drawing& drawing, MakeSurface make_surface, double scale) {
  std::string bytes;
  const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface(
      make_surface(append, &bytes, drawing.width * scale, drawing.height * scale),
      &cairo_surface_destroy);
  const std::unique_ptr<cairo_t, decltype(&cairo_destroy)> c(cairo_create(surface.get()),
                                                             &cairo_destroy);
  cairo_scale(c.get(), scale, scale);
  draw(c.get(), drawing);
  cairo_surface_finish(surface.get());
  const cairo_status_t status = cairo_surface_status(surface.get());
  if (status != CAIRO_STATUS_SUCCESS) {
    throw RendererError(std::string("cairo: ") + cairo_status_to_string(status));
  }
  return bytes;
}

}  // namespace

bool is_vector(const Drawing& drawing) {
  return std::none_of(drawing.items.begin(), drawing.items.end(), [](const Drawing::Item& item) {
    return std::holds_alternative<PointCloud>(item.shape);
  });
}

std::string encode_svg(const Drawing& drawing) {
  return encode(drawing, cairo_svg_surface_create_for_stream, 1);
}

std::string encode_pdf(const Drawing& drawing) {
  return encode(drawing, cairo_pdf_surface_create_for_stream, kPointsAPixel);
}

}  // namespace traverse::render
