#pragma once

#include <kainjow/mustache.hpp>
#include <string>
#include <vector>

namespace traverse::report {

/// A cell of a table: a text, or a number with all its digits for the tooltip.
struct Cell {
  std::string text;
  std::string full;
  bool numeric = false;

  Cell(const char* words) : text(words) {}             // NOLINT: cells are written as lists
  Cell(std::string words) : text(std::move(words)) {}  // NOLINT
  Cell(double value);                                  // NOLINT
  static Cell count(std::size_t value);
};

/// A table as the template table.html reads it. A column is set to the right when its first row's
/// cell is a number.
class HtmlTable {
 public:
  explicit HtmlTable(std::vector<std::string> head) : head_(std::move(head)) {}

  void add_row(std::vector<Cell> cells, bool marked = false);
  bool empty() const { return rows_.empty(); }
  kainjow::mustache::data data() const;

 private:
  struct Row {
    std::vector<Cell> cells;
    bool marked;
  };
  std::vector<std::string> head_;
  std::vector<Row> rows_;
};

}  // namespace traverse::report
