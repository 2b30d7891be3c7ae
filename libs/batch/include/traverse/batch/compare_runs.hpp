#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace traverse::batch {

struct RunsComparisonOptions {
  /// The page tells neither whose machine the runs were made on nor paths on it.
  bool is_private = false;
  std::vector<std::string> command;  ///< for the page
  std::filesystem::path templates;
};

/// How many recordings the runs in these folders are of, by digest, else by name.
/// \throws files::InputError if a run.json is missing or damaged
std::size_t count_recordings(const std::vector<std::filesystem::path>& run_folders);

/// Runs of several recordings and pipelines on one page, as that of a batch: ranking, heat table,
/// accuracy against time, box plots, what failed, how they were compared. Runs of one recording
/// and pipeline with the same changed settings count as repeats. Written are `page` (HTML), its
/// numbers beside it as .json and the leaderboard as .tex.
/// \return the ranking and what leads, for the terminal
/// \throws std::invalid_argument for fewer than two runs; files::InputError if a file of a run is
/// missing or damaged; files::OutputError
std::string write_runs_comparison(const std::vector<std::filesystem::path>& run_folders,
                                  const std::filesystem::path& page,
                                  const RunsComparisonOptions& options);

}  // namespace traverse::batch
