#pragma once

#include <filesystem>

namespace traverse::app {

/// Writes the report of a run and shows how many pictures are drawn.
/// \throws as report::write_run_report does.
void write_report_with_progress(const std::filesystem::path& run_folder,
                                const std::filesystem::path& templates);

}  // namespace traverse::app
