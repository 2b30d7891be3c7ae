#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "text_measure.hpp"

namespace traverse::render {

/// `text` broken at blanks into lines at most `width` pixels wide; a word that is wider alone has a
/// line of its own, shortened.
std::vector<std::string> wrapped(const TextMeasure& measure, std::string_view text, double size,
                                 double width);

}  // namespace traverse::render
