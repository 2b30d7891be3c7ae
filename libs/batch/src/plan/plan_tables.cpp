#include "plan/plan_tables.hpp"

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "traverse/batch/metric.hpp"
#include "traverse/batch/plan.hpp"

#include "plan/plan_error.hpp"
#include "plan/plan_metrics.hpp"
#include "plan/plan_parts.hpp"

namespace traverse::batch {

namespace {

using config::Document;

constexpr std::array<std::pair<std::string_view, TableRows>, 3> kTableRows{
    {{"pipelines", TableRows::kPipelines},
     {"recordings", TableRows::kRecordings},
     {"means", TableRows::kMeans}}};

TableColumn column_of(const std::string& metric, const config::Origin& origin) {
  check_metric(metric, origin);
  return {with_unit(*find_metric(metric)), {metric}, {}};
}

/// "ape_translation_rmse", or {metric: KEY | metrics: [KEY], title: TEXT, decimals: N}.
TableColumn read_column(const Document& item) {
  TableColumn column;
  std::string metric;
  int decimals = -1;
  static constexpr std::array<std::string_view, 1> kOthers{"metrics"};
  config::read(
      item,
      [&](config::Binder& b) {
        b.text("metric", metric, "of `traverse batch metrics`");
        b.text("title", column.title, "its head, with the unit");
        b.integer("decimals", decimals, config::Range::between(0, 12), "of its numbers");
      },
      kOthers);
  if (!metric.empty()) column.metrics.push_back(metric);
  for (const Document& one : item.items("metrics", "name")) {
    column.metrics.push_back(one.scalar("name").value_or(""));
  }
  if (column.metrics.empty()) throw plan_error(item.origin(), "a 'metric'", "none");
  for (const std::string& key : column.metrics) check_metric(key, item.origin());
  if (column.title.empty()) {
    for (const std::string& key : column.metrics) {
      column.title += (column.title.empty() ? "" : " / ") + with_unit(*find_metric(key));
    }
  }
  if (decimals >= 0) column.decimals = decimals;
  return column;
}

PlannedTable read_table(const Document& item, const Plan& plan) {
  PlannedTable table;
  static constexpr std::array<std::string_view, 3> kOthers{"recordings", "pipelines", "columns"};
  config::read(
      item,
      [&](config::Binder& b) {
        b.text("title", table.title, "above it");
        b.text("text", table.text, "below the title");
        b.choice("rows", table.rows, kTableRows, "what a row is");
        b.text("head", table.head, "of the column that names the rows");
      },
      kOthers);
  table.recordings = read_names(item, "recordings", plan.recordings, "recording");
  table.pipelines = read_names(item, "pipelines", plan.pipelines, "pipeline");
  for (const Document& column : item.items("columns", "metric")) {
    table.columns.push_back(read_column(column));
  }
  if (table.columns.empty()) {
    for (const std::string& metric : plan.metrics) {
      table.columns.push_back(column_of(metric, item.origin()));
    }
  }
  return table;
}

}  // namespace

std::vector<PlannedTable> read_tables(const Document& document, const Plan& plan) {
  std::vector<PlannedTable> tables;
  for (const Document& item : document.items("tables", "title")) {
    tables.push_back(read_table(item, plan));
  }
  return tables;
}

}  // namespace traverse::batch
