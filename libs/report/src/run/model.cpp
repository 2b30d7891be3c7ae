#include "run/model.hpp"

#include <charconv>
#include <cmath>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "traverse/page/html_page.hpp"

namespace traverse::report {

namespace {

struct CellJson {
  Json operator()(std::monostate /*undefined*/) const { return nullptr; }
  template <typename Held>
  Json operator()(const Held& held) const {
    return held;
  }
};

}  // namespace

void Model::add_text(const std::string& name, const std::string& text) {
  page.set(name, text);
  json[name] = text;
}

void Model::add_table(Table table) {
  json["tables"][table.id()] = table_json(table);
  page.set("table_" + table.id(), table.empty() ? TemplateData(false) : table.data());
  tables.push_back(std::move(table));
}

Json series_number(double value) {
  if (!std::isfinite(value)) return nullptr;
  const std::string text = fmt::format("{:.9g}", value);
  double rounded = 0;
  std::from_chars(text.data(), text.data() + text.size(), rounded);
  return rounded;
}

Json table_json(const Table& table) {
  Json rows = Json::array();
  Json marked = Json::array();
  for (const Table::Row& row : table.rows()) {
    if (row.marked) marked.push_back(rows.size());
    Json cells = Json::array();
    for (const Cell& cell : row.cells) cells.push_back(std::visit(CellJson{}, cell.value));
    rows.push_back(std::move(cells));
  }
  return {{"title", table.title()},
          {"columns", table.columns()},
          {"rows", std::move(rows)},
          {"marked", std::move(marked)}};
}

std::string script_text(const Json& json) {
  return page::text_for_script(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace traverse::report
