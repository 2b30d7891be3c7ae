#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "traverse/render/drawing.hpp"
#include "traverse/render/style.hpp"

#include "text_measure.hpp"

namespace traverse::render {

/// Half the height of a digit, of its text size: to be centred on a line, a number has its baseline
/// that much below it.
inline constexpr double kHalfDigit = 0.36;

/// Lengths that all parts of a picture share, pixels. They grow with the picture, so that a large
/// one is the same drawing in finer print; in a small one letters shrink less than the rest.
struct Sizes {
  double title = 26;    ///< text sizes
  double body = 17;     ///< statistic, axis names, legends
  double tick = 15;     ///< numbers at axes, notes
  double margin = 32;   ///< around the page
  double gap = 8;       ///< between things that belong together
  double line = 2;      ///< data lines
  double hairline = 1;  ///< grid

  static Sizes for_picture(int width, int height);

  /// Height of a line of text of `text_size`, with its leading.
  static double line_height(double text_size) { return 1.35 * text_size; }
};

/// What the parts of a picture draw on. It knows where text stands and takes no more where there
/// is some already: labels are dropped rather than overlap, so what matters most comes first.
class Canvas {
 public:
  explicit Canvas(const Style& style);

  const Theme& theme() const { return style_.theme; }
  const Sizes& sizes() const { return sizes_; }
  const TextMeasure& measure() const { return measure_; }
  Rect page() const;

  void add(Shape shape, std::optional<Rect> clip = std::nullopt);
  void fill(const Rect& rect, Colour colour, double opacity = 1);
  /// A straight line without round ends; exactly horizontal or vertical ones lie on whole pixels.
  void straight(Point from, Point to, Colour colour, double width);

  /// A text in the size and colour of statistics, axis names and legends.
  Text body(std::string utf8, Point anchor, HorizontalAlign align = HorizontalAlign::kLeft) const;
  /// A smaller, muted one: numbers at axes, remarks.
  Text note(std::string utf8, Point anchor, HorizontalAlign align = HorizontalAlign::kLeft) const;
  /// `text` with a soft edge, to be read above data.
  Text on_data(Text text) const;

  /// Adds `text` if its box is on the page and free; says whether.
  bool text(const Text& text);
  /// Adds `text` at the first of `anchors` where it is free.
  bool text_at_first_free(Text text, const std::vector<Point>& anchors);

  bool is_free(const Rect& rect) const;
  /// Keeps texts out of `rect` from now on.
  void reserve(const Rect& rect) { taken_.push_back(rect); }

  /// `utf8` in at most `width` pixels, shortened if it must be.
  std::string fitted(std::string_view utf8, double size, double width,
                     FontWeight weight = FontWeight::kRegular) const {
    return measure_.fitted(utf8, size, weight, width);
  }
  double width_of(std::string_view utf8, double size,
                  FontWeight weight = FontWeight::kRegular) const {
    return measure_.width(utf8, size, weight);
  }

  Drawing finish() && { return std::move(drawing_); }

 private:
  Style style_;
  Sizes sizes_;
  TextMeasure measure_;
  Drawing drawing_;
  std::vector<Rect> taken_;
};

/// `text` in another colour.
inline Text coloured(Text text, Colour colour) {
  text.colour = colour;
  return text;
}

}  // namespace traverse::render
