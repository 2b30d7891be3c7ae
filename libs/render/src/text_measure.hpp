#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/render/drawing.hpp"
#include "traverse/render/rect.hpp"

namespace traverse::render {

/// Where fonts are looked for: the folder that the environment variable TRAVERSE_FONTS names, then
/// those where the distributions keep DejaVu Sans.
std::vector<std::filesystem::path> font_folders();

/// The file of DejaVu Sans in a weight, from the first of `folders` that has it.
/// \throws files::InputError listing the folders, if none has it.
std::filesystem::path font_file(FontWeight weight,
                                const std::vector<std::filesystem::path>& folders);

/// `text` as it can be drawn on one line: invalid UTF-8 replaced by U+FFFD, control characters by
/// blanks.
std::string printable(std::string_view text);

/// Knows how much room texts take. Cheap to make; not for two threads at once.
class TextMeasure {
 public:
  TextMeasure();
  ~TextMeasure();
  TextMeasure(TextMeasure&&) noexcept;
  TextMeasure& operator=(TextMeasure&&) noexcept;

  /// Width of the ink, pixels.
  double width(std::string_view utf8, double size, FontWeight weight) const;

  /// The room of `text`: its width, and the height of any text of its size.
  Rect box(const Text& text) const;

  /// `utf8` if it is at most `width` wide, else its beginning and end with "…" between them; empty
  /// if not even a few letters fit.
  std::string fitted(std::string_view utf8, double size, FontWeight weight, double width) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace traverse::render
