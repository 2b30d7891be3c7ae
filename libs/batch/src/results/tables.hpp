#pragma once

#include <optional>
#include <string>
#include <vector>

#include "traverse/batch/plan.hpp"
#include "traverse/batch/results.hpp"
#include "traverse/page/table.hpp"

namespace traverse::batch {

/// A planned table as it is shown: under its heading, or a heading alone.
struct ShownTable {
  int level = 2;        ///< of the heading: 2 below the document's, 3 below that
  std::string heading;  ///< may be empty
  std::string text;
  std::optional<page::Table> table;
};

/// The plan's tables with what is there of their runs: a number is the mean over repeats that are
/// ok; a run that is not says why. Tables of pipelines stand recording by recording.
std::vector<ShownTable> shown_tables(const Plan& plan, const Results& results);

/// They as a Markdown document, under the plan's title and description.
/// \param made how, in one sentence
std::string tables_markdown(const Plan& plan, const std::vector<ShownTable>& tables,
                            const std::string& made);

}  // namespace traverse::batch
