#include "traverse/page/table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "traverse/files/number_text.hpp"

namespace traverse::page {

Cell::Cell(double number)
    : text(files::short_number(number)), full(files::full_number(number)), numeric(true) {
  if (std::isfinite(number)) value = number;
}

Cell Cell::count(std::size_t number) {
  Cell cell(files::count_text(number));
  cell.full = std::to_string(number);
  cell.numeric = true;
  cell.value = number;
  return cell;
}

Cell Cell::fixed(double number, int decimals) {
  Cell cell(number);
  if (!std::isfinite(number)) return cell;
  cell.text = fmt::format("{:.{}f}", number, decimals);
  if (cell.text.starts_with('-')) cell.text = "\u2212" + cell.text.substr(1);
  return cell;
}

Cell Cell::moment(std::string words, std::size_t pose) {
  Cell cell(std::move(words));
  cell.pose = pose;
  return cell;
}

void Table::add_row(std::vector<Cell> cells, bool marked) {
  rows_.push_back({std::move(cells), marked});
}

void Table::mark_best(const std::vector<std::size_t>& columns) {
  if (rows_.size() < 2) return;
  for (const std::size_t column : columns) {
    double least = std::numeric_limits<double>::infinity();
    for (const Row& row : rows_) {
      const double* number = std::get_if<double>(&row.cells.at(column).value);
      if (number != nullptr) least = std::min(least, *number);
    }
    for (Row& row : rows_) {
      const double* number = std::get_if<double>(&row.cells[column].value);
      row.cells[column].best = number != nullptr && *number == least;
    }
  }
}

bool Table::is_numeric(std::size_t column) const {
  return !rows_.empty() && rows_.front().cells.at(column).numeric;
}

Data Table::data() const {
  Data head = Data::list();
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    Data column;
    column.set("text", columns_[k]);
    column.set("numeric", is_numeric(k));
    head.push_back(column);
  }
  Data rows = Data::list();
  for (const Row& row : rows_) {
    Data cells = Data::list();
    for (const Cell& cell : row.cells) {
      Data entry;
      entry.set("text", cell.text);
      entry.set("numeric", cell.numeric);
      entry.set("best", cell.best);
      entry.set("full", cell.full.empty() ? Data(false) : Data(cell.full));
      entry.set("pose", cell.pose ? Data(std::to_string(*cell.pose)) : Data(false));
      cells.push_back(entry);
    }
    Data entry;
    entry.set("cells", cells);
    entry.set("marked", row.marked);
    rows.push_back(entry);
  }
  Data table;
  table.set("table_id", id_);
  table.set("table_title", title_);
  table.set("head", head);
  table.set("rows", rows);
  return table;
}

}  // namespace traverse::page
