#include "results/tables.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace traverse::batch {

namespace {

using page::Cell;
using page::Table;

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

bool has_name(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The runs of one recording and variant, a repeat each.
using Repeats = std::vector<const Job*>;

/// The runs that tables are made of.
class Cells {
 public:
  explicit Cells(const Results& results) : results_(results) {
    for (const Job& job : results.jobs()) {
      const auto [group, is_new] = groups_.try_emplace({job.recording, job.variant()});
      group->second.push_back(&job);
      if (is_new) order_.push_back({job.recording, job.pipeline, job.variant()});
    }
  }

  struct Place {
    std::string recording, pipeline, variant;
  };
  /// Of the plan, each once.
  const std::vector<Place>& places() const { return order_; }

  /// The mean over repeats that are ok; nothing if none has the metric.
  std::optional<double> value(const Place& place, const std::string& metric) const {
    double sum = 0;
    double count = 0;
    for (const Job* job : groups_.at({place.recording, place.variant})) {
      const Completion* completion = results_.find(*job);
      if (completion == nullptr || completion->outcome != Outcome::kOk) continue;
      if (const auto value = value_of(*completion, metric)) {
        sum += *value;
        ++count;
      }
    }
    return count > 0 ? std::optional(sum / count) : std::nullopt;
  }

  /// Why no repeat has numbers; empty if one is ok.
  std::string why_none(const Place& place) const {
    std::string why = "not made";
    for (const Job* job : groups_.at({place.recording, place.variant})) {
      const Completion* completion = results_.find(*job);
      if (completion == nullptr) continue;
      if (completion->outcome == Outcome::kOk) return {};
      why = fmt::format("{}: {}", name_of(completion->outcome), completion->reason);
    }
    return why;
  }

 private:
  const Results& results_;
  std::map<std::pair<std::string, std::string>, Repeats> groups_;
  std::vector<Place> order_;
};

Cell number_cell(double value, const TableColumn& column) {
  return column.decimals ? Cell::fixed(value, *column.decimals) : Cell(value);
}

/// "0.048 / 0.171" of several metrics.
Cell cell_of(const TableColumn& column, const std::vector<double>& values) {
  Cell cell = number_cell(values.front(), column);
  for (std::size_t k = 1; k < values.size(); ++k) {
    const Cell next = number_cell(values[k], column);
    cell.text += " / " + next.text;
    cell.full += " / " + next.full;
    cell.value = cell.text;
  }
  return cell;
}

Table begun_table(const PlannedTable& planned, std::size_t number, const std::string& title) {
  std::vector<std::string> heads{planned.head};
  for (const TableColumn& column : planned.columns) heads.push_back(column.title);
  return {fmt::format("planned-{}", number), title, std::move(heads)};
}

void add_run(const PlannedTable& planned, const Cells& cells, const Cells::Place& place,
             const std::string& name, Table& table) {
  std::vector<Cell> row{name};
  const std::string why = cells.why_none(place);
  for (const TableColumn& column : planned.columns) {
    std::vector<double> values;
    for (const std::string& metric : column.metrics) {
      values.push_back(cells.value(place, metric).value_or(kUndefined));
    }
    row.push_back(why.empty() ? cell_of(column, values) : Cell(row.size() == 1 ? why : ""));
  }
  table.add_row(std::move(row));
}

bool is_chosen(const PlannedTable& planned, const Cells::Place& place) {
  return has_name(planned.recordings, place.recording) &&
         has_name(planned.pipelines, place.pipeline);
}

/// The table of one recording, or of one pipeline.
Table table_of(const PlannedTable& planned, const Cells& cells, std::size_t number,
               std::string Cells::Place::*of, std::string Cells::Place::*row,
               const std::string& name) {
  Table table =
      begun_table(planned, number, planned.title.empty() ? name : planned.title + ", " + name);
  for (const Cells::Place& place : cells.places()) {
    if (is_chosen(planned, place) && place.*of == name) {
      add_run(planned, cells, place, place.*row, table);
    }
  }
  return table;
}

/// A pipeline's means over its recordings.
Table means_table(const PlannedTable& planned, const Cells& cells, std::size_t number) {
  Table table = begun_table(planned, number, planned.title);
  std::vector<std::string> variants;
  for (const Cells::Place& place : cells.places()) {
    if (is_chosen(planned, place) && !has_name(variants, place.variant)) {
      variants.push_back(place.variant);
    }
  }
  for (const std::string& variant : variants) {
    std::vector<Cell> row{variant};
    for (const TableColumn& column : planned.columns) {
      std::vector<double> means;
      for (const std::string& metric : column.metrics) {
        double sum = 0;
        double count = 0;
        for (const Cells::Place& place : cells.places()) {
          if (place.variant != variant || !is_chosen(planned, place)) continue;
          if (const auto value = cells.value(place, metric)) {
            sum += *value;
            ++count;
          }
        }
        means.push_back(count > 0 ? sum / count : kUndefined);
      }
      row.push_back(cell_of(column, means));
    }
    table.add_row(std::move(row));
  }
  return table;
}

}  // namespace

std::vector<ShownTable> shown_tables(const Plan& plan, const Results& results) {
  const Cells cells(results);
  std::vector<ShownTable> shown;
  std::size_t number = 0;
  for (const PlannedRecording& recording : plan.recordings) {
    bool has_heading = false;
    for (const PlannedTable& planned : plan.tables) {
      if (planned.rows != TableRows::kPipelines) continue;
      Table table = table_of(planned, cells, number + 1, &Cells::Place::recording,
                             &Cells::Place::variant, recording.name);
      if (table.empty()) continue;
      ++number;
      if (!has_heading) shown.push_back({2, recording.name, recording.text, {}});
      has_heading = true;
      shown.push_back({3, planned.title, planned.text, std::move(table)});
    }
  }
  for (const PlannedTable& planned : plan.tables) {
    if (planned.rows == TableRows::kPipelines) continue;
    if (planned.rows == TableRows::kMeans) {
      shown.push_back({2, planned.title, planned.text, means_table(planned, cells, ++number)});
      continue;
    }
    shown.push_back({2, planned.title, planned.text, {}});
    for (const std::string& pipeline : planned.pipelines) {
      Table table = table_of(planned, cells, number + 1, &Cells::Place::pipeline,
                             &Cells::Place::recording, pipeline);
      if (table.empty()) continue;
      ++number;
      shown.push_back({3, planned.pipelines.size() > 1 ? pipeline : "", "", std::move(table)});
    }
  }
  return shown;
}

std::string tables_markdown(const Plan& plan, const std::vector<ShownTable>& tables,
                            const std::string& made) {
  std::string text = fmt::format("# {}\n\n{}\n",
                                 plan.title.empty() ? plan.file.stem().string() : plan.title, made);
  if (!plan.description.empty()) text += fmt::format("\n{}\n", plan.description);
  for (const ShownTable& shown : tables) {
    if (!shown.heading.empty()) {
      text += fmt::format("\n{} {}\n", std::string(static_cast<std::size_t>(shown.level), '#'),
                          shown.heading);
    }
    if (!shown.text.empty()) text += fmt::format("\n{}\n", shown.text);
    if (shown.table) text += "\n" + page::to_markdown(*shown.table);
  }
  return text;
}

}  // namespace traverse::batch
