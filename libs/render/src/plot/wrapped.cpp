#include "plot/wrapped.hpp"

#include <utility>

namespace traverse::render {

std::vector<std::string> wrapped(const TextMeasure& measure, std::string_view text, double size,
                                 double width) {
  std::vector<std::string> lines;
  std::string line;
  const auto finish_line = [&] {
    if (!line.empty()) lines.push_back(measure.fitted(line, size, FontWeight::kRegular, width));
    line.clear();
  };
  while (!text.empty()) {
    const std::size_t blank = text.find(' ');
    const std::string word(text.substr(0, blank));
    text.remove_prefix(blank == std::string_view::npos ? text.size() : blank + 1);
    if (word.empty()) continue;
    std::string longer = line;
    if (!line.empty()) longer += ' ';
    longer += word;
    if (!line.empty() && measure.width(longer, size, FontWeight::kRegular) > width) {
      finish_line();
      line = word;
    } else {
      line = std::move(longer);
    }
  }
  finish_line();
  return lines;
}

}  // namespace traverse::render
