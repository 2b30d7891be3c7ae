#pragma once

#include <span>
#include <string_view>

#include "run/model.hpp"
#include "run/report_input.hpp"

namespace traverse::report {

class FigureMaker;

/// A section of a run's page: all that has to be told of one. Its text is the template
/// run/ID.html; contents and order of the page are those of the table.
struct ReportSection {
  std::string_view id;     ///< its anchor and the name of its template
  std::string_view title;  ///< in the contents and above it
  bool (*applies)(const RunData& run);
  void (*fill)(const ReportInput& input, Model& model);  ///< texts and tables
  /// Its pictures, in their order; null if it has none.
  void (*draw)(const ReportInput& input, FigureMaker& maker) = nullptr;
  /// Its interactive charts; null if it has none.
  void (*chart)(const RunData& run, Json& charts) = nullptr;
};

/// Every section, in the order of the page.
std::span<const ReportSection> report_sections();

}  // namespace traverse::report
