#pragma once

#include <kainjow/mustache.hpp>
#include <string>

#include <nlohmann/json.hpp>

#include "page/html_table.hpp"

namespace traverse::report {

using Json = nlohmann::ordered_json;
using TemplateData = kainjow::mustache::data;

/// A report, twice: as its templates read it and as report.json (docs/report-json.md). What has a
/// number enters both by one call, so that they cannot differ.
struct Model {
  TemplateData page;
  Json json = Json::object();

  /// The text under `name` in the page and in the JSON.
  void add_text(const std::string& name, const std::string& text);
  /// The table under "tables" in the JSON, and under its id in the page; false there when empty.
  void add_table(const HtmlTable& table);
};

/// A number of a long series as the JSON holds it: nine significant digits, null where not finite.
Json series_number(double value);

/// JSON that may stand in a script element: "<", ">" and "&" as \u escapes.
std::string text_for_script(const Json& json);

}  // namespace traverse::report
