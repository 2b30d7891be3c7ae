#include "typeface.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "text_measure.hpp"

namespace traverse::render {

namespace {

constexpr double kHaloRadius = 0.14;  // of the text's size
constexpr double kHaloOpacity = 0.85;

cv::Ptr<cv::freetype::FreeType2> load(FontWeight weight) {
  auto face = cv::freetype::createFreeType2();
  face->loadFontData(font_file(weight, font_folders()).string(), 0);
  return face;
}

int raster_height(double size) {
  return std::max(1, static_cast<int>(std::lround(size * Typeface::kOversampling)));
}

/// Paints `colour` over `image` where `coverage` (of the same size) says.
void blend(const cv::Mat& coverage, Colour colour, double opacity, cv::Mat image) {
  const int channels[3] = {colour.red, colour.green, colour.blue};
  for (int row = 0; row < image.rows; ++row) {
    const auto* share = coverage.ptr<std::uint8_t>(row);
    auto* pixel = image.ptr<std::uint8_t>(row);
    for (int column = 0; column < image.cols; ++column, pixel += 3) {
      const int alpha = static_cast<int>(std::lround(share[column] * opacity));
      for (int c = 0; c < 3; ++c) {
        pixel[c] =
            static_cast<std::uint8_t>((pixel[c] * (255 - alpha) + channels[c] * alpha + 127) / 255);
      }
    }
  }
}

/// Averages an oversampled coverage whose first pixel is (left, top) in oversampled coordinates of
/// the image, and blends it in, leaving away what is outside.
void blend_oversampled(const cv::Mat& coverage, int left, int top, Colour colour, double opacity,
                       cv::Mat& image) {
  constexpr int k = Typeface::kOversampling;
  const auto floored = [](int value) { return value >= 0 ? value / k : -((-value + k - 1) / k); };
  const cv::Point first(floored(left), floored(top));
  const cv::Point last(floored(left + coverage.cols) + 1, floored(top + coverage.rows) + 1);
  cv::Mat aligned(k * (last.y - first.y), k * (last.x - first.x), CV_8UC1, cv::Scalar(0));
  coverage.copyTo(aligned({left - k * first.x, top - k * first.y, coverage.cols, coverage.rows}));
  cv::Mat averaged;
  cv::resize(aligned, averaged, {last.x - first.x, last.y - first.y}, 0, 0, cv::INTER_AREA);
  const cv::Rect visible = cv::Rect(first, last) & cv::Rect(0, 0, image.cols, image.rows);
  if (visible.empty()) return;
  blend(averaged(visible - first), colour, opacity, image(visible));
}

}  // namespace

Typeface::Typeface() : regular_(load(FontWeight::kRegular)), bold_(load(FontWeight::kBold)) {}

cv::freetype::FreeType2& Typeface::face(FontWeight weight) const {
  return weight == FontWeight::kBold ? *bold_ : *regular_;
}

int Typeface::ink_width(const std::string& utf8, double size, FontWeight weight) const {
  if (utf8.find_first_not_of(' ') == std::string::npos) return 0;  // FreeType has no box for it
  int baseline = 0;
  return face(weight).getTextSize(utf8, raster_height(size), -1, &baseline).width;
}

Typeface::Ink Typeface::rasterise(const Text& text) const {
  const std::string utf8 = printable(text.utf8);
  const int width = ink_width(utf8, text.size, text.weight);
  if (width <= 0) return {};
  const int height = raster_height(text.size);
  // Room on every side: the first letter may begin left of the pen, accents and stacked marks
  // reach above and below.
  const int room = 2 * height;
  cv::Mat canvas(4 * height, width + 2 * room, CV_8UC3, cv::Scalar::all(0));
  face(text.weight)
      .putText(canvas, utf8, {room, room}, height, cv::Scalar::all(255), -1, cv::LINE_AA, true);
  cv::Mat coverage;
  cv::extractChannel(canvas, coverage, 0);
  const cv::Rect ink = cv::boundingRect(coverage);
  if (ink.empty()) return {};
  return {coverage({ink.x, 0, ink.width, coverage.rows}).clone(), room};
}

void Typeface::paint(const Text& text, cv::Mat& image) const {
  const Ink ink = rasterise(text);
  if (ink.coverage.empty()) return;
  const double share = text.align == HorizontalAlign::kLeft     ? 0.0
                       : text.align == HorizontalAlign::kCentre ? 0.5
                                                                : 1.0;
  const int left =
      static_cast<int>(std::lround(kOversampling * text.anchor.x - share * ink.coverage.cols));
  // On a whole pixel, so that the feet of the letters are sharp.
  const int top = kOversampling * static_cast<int>(std::lround(text.anchor.y)) - ink.baseline;
  if (text.halo) {
    const int radius =
        std::max(1, static_cast<int>(std::lround(raster_height(text.size) * kHaloRadius)));
    cv::Mat wide;
    cv::copyMakeBorder(ink.coverage, wide, 0, 0, 2 * radius, 2 * radius, cv::BORDER_CONSTANT, 0);
    cv::dilate(wide, wide,
               cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius + 1, 2 * radius + 1}));
    cv::blur(wide, wide, {radius + 1, radius + 1});
    blend_oversampled(wide, left - 2 * radius, top, *text.halo, kHaloOpacity, image);
  }
  blend_oversampled(ink.coverage, left, top, text.colour, 1, image);
}

}  // namespace traverse::render
