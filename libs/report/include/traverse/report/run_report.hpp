#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include "traverse/report/budget.hpp"

namespace traverse::report {

struct RunReportOptions {
  bool pictures = true;      ///< draw images/*.png and put them into the page
  int picture_width = 1600;  ///< pixels
  /// Also writes those of point clouds so wide, for paper: images/NAME_print.png, up to 8192.
  std::optional<int> print_width;
  std::optional<std::filesystem::path> budget;   ///< limits to check; shown on the page
  std::optional<std::filesystem::path> exports;  ///< folder for every table as CSV and LaTeX
  /// What the page calls the folder, if that is to be renamed; empty: by its name.
  std::filesystem::path folder_on_page;
  /// The page tells neither whose machine the run was made on nor paths on it. So is, in any case,
  /// that of a run whose run.json does not tell them, and one with a budget that asks for it.
  bool is_private = false;
  /// Once it is true ReportStopped is thrown before the next picture.
  const std::atomic<bool>* stop = nullptr;
  /// Called with the name of each picture that is finished, from one thread at a time.
  std::function<void(const std::string&)> picture_drawn = [](const std::string&) {};
};

/// The user stopped it; an earlier report is as it was.
class ReportStopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Draws the pictures of a finished run (images/*.png, for light and for dark pages; line plots
/// also as SVG and PDF) and writes report.html, one self-contained file, and report.json, its
/// numbers (docs/report-json.md): all made from the run folder alone. They come into their places
/// when all of them are complete; until then an earlier report stays whole, however this ends.
/// \param templates folder with page.html, run/*.html, ...
/// \return what the budget said, if there was one
/// \throws files::InputError if a file of the run is missing or damaged; files::FolderInUse if
/// another process makes the report of this run; files::OutputError; ReportStopped
std::optional<BudgetResult> write_run_report(const std::filesystem::path& run_folder,
                                             const std::filesystem::path& templates,
                                             const RunReportOptions& options = {});

}  // namespace traverse::report
