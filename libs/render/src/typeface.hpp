#pragma once

#include <string>

#include <opencv2/core.hpp>
#include <opencv2/freetype.hpp>

#include "traverse/render/drawing.hpp"

namespace traverse::render {

/// DejaVu Sans in both weights, rasterised larger than asked for and averaged down: hinting of
/// small sizes moves letters to whole pixels, which spaces words unevenly.
class Typeface {
 public:
  static constexpr int kOversampling = 4;

  /// \throws files::InputError if a font file is missing.
  Typeface();

  /// Width of the ink, oversampled pixels.
  int ink_width(const std::string& utf8, double size, FontWeight weight) const;

  /// Adds `text` to an image in RGB.
  void paint(const Text& text, cv::Mat& image) const;

 private:
  struct Ink {
    cv::Mat coverage;  ///< oversampled, one byte a pixel, cropped left and right to the ink
    int baseline = 0;  ///< its row in `coverage`
  };
  Ink rasterise(const Text& text) const;
  cv::freetype::FreeType2& face(FontWeight weight) const;

  cv::Ptr<cv::freetype::FreeType2> regular_;
  cv::Ptr<cv::freetype::FreeType2> bold_;
};

}  // namespace traverse::render
