#include "text_measure.hpp"

#include <vector>

#include "typeface.hpp"

namespace traverse::render {

namespace {

// Of DejaVu Sans, as shares of the size: no letter with an accent is higher, no descender lower.
constexpr double kAscent = 0.90;
constexpr double kDescent = 0.24;
constexpr std::string_view kEllipsis = "…";

/// Where each character of valid UTF-8 begins, and the end.
std::vector<std::size_t> character_starts(std::string_view utf8) {
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < utf8.size(); ++i) {
    if ((static_cast<unsigned char>(utf8[i]) & 0xC0) != 0x80) starts.push_back(i);
  }
  starts.push_back(utf8.size());
  return starts;
}

}  // namespace

class TextMeasure::Impl {
 public:
  Typeface typeface;
};

TextMeasure::TextMeasure() : impl_(std::make_unique<Impl>()) {}
TextMeasure::~TextMeasure() = default;
TextMeasure::TextMeasure(TextMeasure&&) noexcept = default;
TextMeasure& TextMeasure::operator=(TextMeasure&&) noexcept = default;

double TextMeasure::width(std::string_view utf8, double size, FontWeight weight) const {
  const int oversampled = impl_->typeface.ink_width(printable(utf8), size, weight);
  return static_cast<double>(oversampled) / Typeface::kOversampling;
}

Rect TextMeasure::box(const Text& text) const {
  const double wide = width(text.utf8, text.size, text.weight);
  const double share = text.align == HorizontalAlign::kLeft     ? 0.0
                       : text.align == HorizontalAlign::kCentre ? 0.5
                                                                : 1.0;
  const double left = text.anchor.x - share * wide;
  return {left, text.anchor.y - kAscent * text.size, left + wide,
          text.anchor.y + kDescent * text.size};
}

std::string TextMeasure::fitted(std::string_view utf8, double size, FontWeight weight,
                                double width_available) const {
  std::string whole = printable(utf8);
  if (width(whole, size, weight) <= width_available) return whole;
  const std::vector<std::size_t> starts = character_starts(whole);
  const std::size_t count = starts.size() - 1;
  const auto shortened = [&](std::size_t kept) {
    const std::size_t front = (2 * kept + 2) / 3;  // the beginning says more than the end
    return whole.substr(0, starts[front]) + std::string(kEllipsis) +
           whole.substr(starts[count - (kept - front)]);
  };
  std::size_t most = 0;  // characters that fit; more never take less room
  std::size_t too_many = count;
  while (most + 1 < too_many) {
    const std::size_t kept = (most + too_many) / 2;
    (width(shortened(kept), size, weight) <= width_available ? most : too_many) = kept;
  }
  return most >= 3 ? shortened(most) : std::string();
}

}  // namespace traverse::render
