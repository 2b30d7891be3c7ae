#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace traverse::report {

struct RunReportOptions {
  /// Called with the name of each picture that is finished.
  std::function<void(const std::string&)> picture_drawn = [](const std::string&) {};
};

/// Draws the pictures of a finished run (images/*.png, for light and for dark pages) and writes
/// report.html: one self-contained file, made from the run folder alone.
/// \param templates folder with run.html, run.css
/// \throws files::InputError if a file of the run is missing or damaged; files::OutputError
void write_run_report(const std::filesystem::path& run_folder,
                      const std::filesystem::path& templates, const RunReportOptions& options = {});

}  // namespace traverse::report
