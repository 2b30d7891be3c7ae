#include "table.hpp"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace traverse::app {

namespace {

/// Characters that the terminal shows: bytes of UTF-8 that do not continue another.
std::size_t shown_width(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
}

std::vector<std::string> broken_lines(std::string_view text, std::size_t max_width) {
  std::vector<std::string> lines(1);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    std::string& line = lines.back();
    if (line.empty()) {
      line = word;
    } else if (shown_width(line) + 1 + shown_width(word) <= max_width) {
      line += " " + std::string(word);
    } else {
      lines.emplace_back(word);
    }
  }
  return lines;
}

}  // namespace

void Table::add_row(std::vector<std::string> cells) {
  if (cells.size() != columns_.size()) throw std::invalid_argument("a row needs a cell a column");
  rows_.push_back(std::move(cells));
}

std::string Table::text(std::size_t indent) const {
  std::vector<std::vector<std::vector<std::string>>> cells;  // by row and column: lines
  std::vector<std::size_t> widths(columns_.size(), 0);
  for (const auto& row : rows_) {
    auto& lines = cells.emplace_back();
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      lines.push_back(broken_lines(row[c], columns_[c].max_width));
      for (const std::string& line : lines.back()) {
        widths[c] = std::max(widths[c], shown_width(line));
      }
    }
  }
  std::string text;
  for (const auto& row : cells) {
    std::size_t height = 0;
    for (const auto& lines : row) height = std::max(height, lines.size());
    for (std::size_t i = 0; i < height; ++i) {
      std::string line(indent, ' ');
      for (std::size_t c = 0; c < columns_.size(); ++c) {
        const std::string cell = i < row[c].size() ? row[c][i] : std::string();
        const std::string padding(widths[c] - shown_width(cell), ' ');
        line += columns_[c].align == Align::kLeft ? cell + padding : padding + cell;
        line += "  ";
      }
      line.erase(line.find_last_not_of(' ') + 1);
      text += line + "\n";
    }
  }
  return text;
}

}  // namespace traverse::app
