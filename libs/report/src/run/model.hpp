#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "traverse/page/data.hpp"
#include "traverse/page/table.hpp"

namespace traverse::report {

using Json = nlohmann::ordered_json;
using TemplateData = page::Data;
using page::Cell;
using page::Table;

/// A report, twice: as its templates read it and as report.json (docs/report-json.md). What has a
/// number enters both by one call, so that they cannot differ.
struct Model {
  TemplateData page;
  Json json = Json::object();
  std::vector<Table> tables;

  /// The text under `name` in the page and in the JSON.
  void add_text(const std::string& name, const std::string& text);
  /// One that was added.
  std::string text(const std::string& name) const { return json.at(name).get<std::string>(); }
  /// The table under "tables" in the JSON, and under its id in the page; false there when empty.
  void add_table(Table table);
};

/// A number of a long series as the JSON holds it: nine significant digits, null where not finite.
Json series_number(double value);

/// {"title", "columns": [name], "rows": [[number | text | null]], "marked": [row]}
Json table_json(const Table& table);

/// The JSON as it is written and as it may stand in a page; bytes that are not UTF-8 are replaced.
std::string script_text(const Json& json);

}  // namespace traverse::report
