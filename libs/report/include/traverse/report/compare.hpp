#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace traverse::report {

struct CompareOptions {
  /// A difference counts when its whole interval lies beyond so many percent of the baseline.
  double threshold_percent = 1;
  /// The page tells neither whose machine the runs were made on nor paths on it.
  bool is_private = false;
};

/// Compares runs of one recording, the first being the baseline, and writes `page` (one
/// self-contained HTML file) and its numbers beside it as .json (docs/report-json.md).
///
/// Differences are judged by the paired moving-block bootstrap over the moments that both runs
/// have: improved, no change or regressed.
/// \return the tables for the terminal
/// \throws std::invalid_argument for fewer than two runs; files::InputError if a file of a run is
/// missing or damaged or the runs are of different recordings; files::OutputError
std::string write_comparison(const std::vector<std::filesystem::path>& runs,
                             const std::filesystem::path& page,
                             const std::filesystem::path& templates,
                             const CompareOptions& options = {});

}  // namespace traverse::report
