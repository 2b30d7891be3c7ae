#include "html_table.hpp"

#include "number_text.hpp"

namespace traverse::report {

Cell::Cell(double value) : text(short_number(value)), full(full_number(value)), numeric(true) {}

Cell Cell::count(std::size_t value) {
  Cell cell(count_text(value));
  cell.numeric = true;
  return cell;
}

void HtmlTable::add_row(std::vector<Cell> cells, bool marked) {
  rows_.push_back({std::move(cells), marked});
}

kainjow::mustache::data HtmlTable::data() const {
  using Data = kainjow::mustache::data;
  Data head{Data::type::list};
  for (std::size_t k = 0; k < head_.size(); ++k) {
    Data column;
    column.set("text", head_[k]);
    column.set("numeric", !rows_.empty() && rows_.front().cells.at(k).numeric);
    head.push_back(column);
  }
  Data rows{Data::type::list};
  for (const Row& row : rows_) {
    Data cells{Data::type::list};
    for (const Cell& cell : row.cells) {
      Data entry;
      entry.set("text", cell.text);
      entry.set("numeric", cell.numeric);
      if (cell.full.empty()) {
        entry.set("full", false);
      } else {
        entry.set("full", cell.full);
      }
      cells.push_back(entry);
    }
    Data entry;
    entry.set("cells", cells);
    entry.set("marked", row.marked);
    rows.push_back(entry);
  }
  Data table;
  table.set("head", head);
  table.set("rows", rows);
  return table;
}

}  // namespace traverse::report
