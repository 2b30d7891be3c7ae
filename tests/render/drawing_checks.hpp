#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "traverse/render/drawing.hpp"

#include "text_measure.hpp"

namespace traverse::render {

inline std::vector<std::string> texts_of(const Drawing& drawing) {
  std::vector<std::string> texts;
  for (const Text& text : drawing.texts) texts.push_back(text.utf8);
  return texts;
}

/// Whether any text of the drawing contains `part`.
inline bool says(const Drawing& drawing, const std::string& part) {
  return std::any_of(drawing.texts.begin(), drawing.texts.end(),
                     [&](const Text& text) { return text.utf8.find(part) != std::string::npos; });
}

template <typename Kind>
std::vector<const Kind*> all_of_kind(const Drawing& drawing) {
  std::vector<const Kind*> found;
  for (const Drawing::Item& item : drawing.items) {
    if (const auto* shape = std::get_if<Kind>(&item.shape)) found.push_back(shape);
  }
  return found;
}

/// The polylines of `colour`.
inline std::vector<const Polyline*> lines_of(const Drawing& drawing, Colour colour) {
  std::vector<const Polyline*> found = all_of_kind<Polyline>(drawing);
  std::erase_if(found, [&](const Polyline* line) { return line->colour != colour; });
  return found;
}

/// The line of `colour` with the most points: that of the data, not of a legend or a mark.
inline const Polyline& data_line(const Drawing& drawing, Colour colour) {
  const auto lines = lines_of(drawing, colour);
  return **std::max_element(lines.begin(), lines.end(), [](const Polyline* a, const Polyline* b) {
    return a->points.size() < b->points.size();
  });
}

/// No label lies on another or leaves the page.
inline void expect_readable(const Drawing& drawing) {
  const TextMeasure measure;
  const Rect page{0, 0, static_cast<double>(drawing.width), static_cast<double>(drawing.height)};
  std::vector<Rect> boxes;
  for (const Text& text : drawing.texts) {
    const Rect box = measure.box(text);
    EXPECT_TRUE(page.contains(box)) << printable(text.utf8);
    EXPECT_FALSE(text.utf8.empty());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      EXPECT_FALSE(boxes[i].overlaps(box))
          << printable(drawing.texts[i].utf8) << " | " << printable(text.utf8);
    }
    boxes.push_back(box);
  }
}

}  // namespace traverse::render
