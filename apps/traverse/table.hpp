#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace traverse::app {

/// Text in aligned columns for the terminal. Cells that are wider than their column may be are
/// broken between words.
class Table {
 public:
  enum class Align { kLeft, kRight };
  struct Column {
    Align align = Align::kLeft;
    std::size_t max_width = 60;
  };

  explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

  /// \throws std::invalid_argument unless there is one cell a column.
  void add_row(std::vector<std::string> cells);

  /// The rows as lines, each after `indent` blanks, two blanks between columns.
  std::string text(std::size_t indent) const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace traverse::app
