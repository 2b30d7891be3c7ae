#pragma once

#include <filesystem>

#include "traverse/report/run_report.hpp"

namespace traverse::app {

/// Writes the report of a run and shows how many pictures are drawn.
/// \throws as report::write_run_report does.
std::optional<report::BudgetResult> write_report_with_progress(
    const std::filesystem::path& run_folder, const std::filesystem::path& templates,
    report::RunReportOptions options = {});

}  // namespace traverse::app
