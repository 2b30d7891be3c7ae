#include "ascii_points.hpp"

#include <fmt/format.h>

#include "traverse/files/numbers.hpp"

#include "field_values.hpp"

namespace traverse::dataset {

namespace {

std::string_view next_point_line(FileCursor& file, std::size_t read, std::size_t points) {
  for (;;) {
    const auto line = file.next_line();
    if (!line) {
      throw file.error(fmt::format("{} points", points), fmt::format("the end after {}", read));
    }
    if (line->find_first_not_of(" \t") != std::string_view::npos) return *line;
  }
}

}  // namespace

void read_ascii_points(FileCursor& file, std::size_t points,
                       const std::vector<AsciiColumn>& columns) {
  std::size_t words_a_line = 0;
  for (const AsciiColumn& column : columns) words_a_line += column.words;

  for (std::size_t i = 0; i < points; ++i) {
    const std::string_view line = next_point_line(file, i, points);
    const std::vector<std::string_view> words = files::split_words(line, words_a_line + 1);
    if (words.size() != words_a_line) {
      throw file.error(fmt::format("{} values a point", words_a_line),
                       words.size() > words_a_line ? "more" : fmt::format("{}", words.size()));
    }
    std::size_t word = 0;
    for (const AsciiColumn& column : columns) {
      if (column.values != nullptr && !parse_into(*column.values, i, words[word])) {
        throw file.error("a number of the field's type", files::in_quotes(words[word]));
      }
      word += column.words;
    }
  }
}

}  // namespace traverse::dataset
