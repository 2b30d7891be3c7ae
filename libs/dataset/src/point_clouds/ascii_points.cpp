#include "point_clouds/ascii_points.hpp"

#include <fmt/format.h>

#include "traverse/files/numbers.hpp"

#include "point_clouds/field_values.hpp"

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

/// Without a list of them, which would outweigh the line.
std::size_t count_words(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r";
  std::size_t words = 0;
  for (std::size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos;
       at = line.find_first_not_of(kBlanks, line.find_first_of(kBlanks, at))) {
    ++words;
  }
  return words;
}

}  // namespace

void read_ascii_points(FileCursor& file, std::size_t points, std::vector<AsciiColumn>& columns) {
  std::size_t words_a_line = 0;
  for (const AsciiColumn& column : columns) words_a_line += column.words;

  for (std::size_t i = 0; i < points; ++i) {
    const std::string_view line = next_point_line(file, i, points);
    const std::vector<std::string_view> words = files::split_words(line, words_a_line + 1);
    if (words.size() != words_a_line) {
      throw file.error(fmt::format("{} values a point", words_a_line),
                       fmt::format("{}", count_words(line)));
    }
    std::size_t word = 0;
    for (AsciiColumn& column : columns) {
      const bool is_read = column.values != nullptr && !column.is_left_out;
      if (is_read && !parse_into(*column.values, i, words[word])) {
        if (!column.may_hold_other_text) {
          throw file.error("a number of the field's type", files::in_quotes(words[word]));
        }
        column.is_left_out = true;
      }
      word += column.words;
    }
  }
}

}  // namespace traverse::dataset
