#pragma once

#include <kainjow/mustache.hpp>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace traverse::report {

/// A cell of a table: a text, or a number with all its digits for the tooltip.
struct Cell {
  std::string text;
  std::string full;
  bool numeric = false;
  nlohmann::ordered_json value;     ///< as report.json holds it: number, text or null
  std::optional<std::size_t> pose;  ///< a moment of the run that the cell leads to

  Cell(const char* words) : text(words), value(words) {}            // NOLINT: cells are lists
  Cell(std::string words) : text(std::move(words)), value(text) {}  // NOLINT
  Cell(double value);                                               // NOLINT
  static Cell count(std::size_t value);
  /// A text that leads to a moment of the run when it is clicked.
  static Cell moment(std::string words, std::size_t pose);
};

/// A table as the template table.html reads it and as report.json holds it. A column is set to the
/// right when its first row's cell is a number.
class HtmlTable {
 public:
  /// `id` is its anchor and its name in report.json; `title` says what it shows.
  HtmlTable(std::string id, std::string title, std::vector<std::string> head)
      : id_(std::move(id)), title_(std::move(title)), head_(std::move(head)) {}

  void add_row(std::vector<Cell> cells, bool marked = false);
  bool empty() const { return rows_.empty(); }
  const std::string& id() const { return id_; }
  kainjow::mustache::data data() const;
  /// {"title", "columns": [name], "rows": [[number | text | null]], "marked": [row]}
  nlohmann::ordered_json json() const;

 private:
  struct Row {
    std::vector<Cell> cells;
    bool marked;
  };
  std::string id_;
  std::string title_;
  std::vector<std::string> head_;
  std::vector<Row> rows_;
};

}  // namespace traverse::report
