#include "page/html_table.hpp"

#include <cmath>

#include "page/number_text.hpp"

namespace traverse::report {

Cell::Cell(double number) : text(short_number(number)), full(full_number(number)), numeric(true) {
  if (std::isfinite(number)) value = number;
}

Cell Cell::count(std::size_t number) {
  Cell cell(count_text(number));
  cell.full = std::to_string(number);
  cell.numeric = true;
  cell.value = number;
  return cell;
}

Cell Cell::moment(std::string words, std::size_t pose) {
  Cell cell(std::move(words));
  cell.pose = pose;
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

nlohmann::ordered_json HtmlTable::json() const {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  nlohmann::ordered_json marked = nlohmann::ordered_json::array();
  for (const Row& row : rows_) {
    if (row.marked) marked.push_back(rows.size());
    nlohmann::ordered_json cells = nlohmann::ordered_json::array();
    for (const Cell& cell : row.cells) cells.push_back(cell.value);
    rows.push_back(std::move(cells));
  }
  return {{"title", title_}, {"columns", head_}, {"rows", std::move(rows)}, {"marked", marked}};
}

}  // namespace traverse::report
