#pragma once

#include <optional>
#include <string>
#include <vector>

namespace traverse::batch {

/// A column of a planned table: one metric, or several of a run with " / " between them.
struct TableColumn {
  std::string title;
  std::vector<std::string> metrics;
  std::optional<int> decimals;  ///< nothing: three or four significant digits
};

/// What the rows of a planned table are.
enum class TableRows {
  kPipelines,   ///< a table for each recording
  kRecordings,  ///< a table for each pipeline
  kMeans,       ///< one table: each pipeline's mean over the recordings
};

/// A table that a plan asks for beside the leaderboard.
struct PlannedTable {
  std::string title;  ///< may be empty
  std::string text;   ///< above it
  TableRows rows = TableRows::kPipelines;
  std::string head;                     ///< of the column that names the rows
  std::vector<std::string> recordings;  ///< names of the plan, in its order
  std::vector<std::string> pipelines;
  std::vector<TableColumn> columns;
};

}  // namespace traverse::batch
