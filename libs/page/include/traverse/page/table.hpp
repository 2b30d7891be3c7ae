#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "traverse/page/data.hpp"

namespace traverse::page {

/// A cell of a table: a text, or a number with all its digits for the tooltip.
struct Cell {
  /// Nothing for a number that is not defined.
  using Value = std::variant<std::monostate, std::string, double, std::size_t>;

  std::string text;
  std::string full;
  bool numeric = false;
  bool best = false;  ///< of its column: set in bold
  Value value;
  std::optional<std::size_t> pose;  ///< a moment of the run that the cell leads to

  Cell(const char* words) : Cell(std::string(words)) {}             // NOLINT: cells are lists
  Cell(std::string words) : text(std::move(words)), value(text) {}  // NOLINT
  Cell(double number);                                              // NOLINT
  static Cell count(std::size_t number);
  /// A number with so many decimals, as tables for paper have it.
  static Cell fixed(double number, int decimals);
  /// A text that leads to a moment of the run when it is clicked.
  static Cell moment(std::string words, std::size_t pose);
};

/// A table as the template table.html reads it and as files for other programs hold it. A column is
/// set to the right when its first row's cell is a number.
class Table {
 public:
  struct Row {
    std::vector<Cell> cells;
    bool marked = false;  ///< set apart
  };

  /// `id` is its anchor and the name of its files; `title` says what it shows.
  Table(std::string id, std::string title, std::vector<std::string> columns)
      : id_(std::move(id)), title_(std::move(title)), columns_(std::move(columns)) {}

  void add_row(std::vector<Cell> cells, bool marked = false);
  /// Marks the least number of each column that is named, where there is more than one row.
  void mark_best(const std::vector<std::size_t>& columns);

  bool empty() const { return rows_.empty(); }
  const std::string& id() const { return id_; }
  const std::string& title() const { return title_; }
  const std::vector<std::string>& columns() const { return columns_; }
  const std::vector<Row>& rows() const { return rows_; }
  bool is_numeric(std::size_t column) const;

  Data data() const;

 private:
  std::string id_;
  std::string title_;
  std::vector<std::string> columns_;
  std::vector<Row> rows_;
};

/// The table as CSV (RFC 4180, all digits), LaTeX (booktabs) and Markdown, the last two with
/// numbers as the page shows them, Markdown's in plain characters. reports/templates/tables.js
/// writes the same CSV and LaTeX.
std::string to_csv(const Table& table);
std::string to_latex(const Table& table);
std::string to_markdown(const Table& table);

/// Title and rows in aligned columns, for a terminal.
std::string to_text(const Table& table);

/// Every table as ID.csv and ID.tex. \throws files::OutputError
void export_tables(const std::vector<Table>& tables, const std::filesystem::path& folder);

}  // namespace traverse::page
