#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "traverse/batch/results.hpp"
#include "traverse/page/table.hpp"

namespace traverse::batch {

/// The two averages of KITTI drift that papers give, which are not the same.
struct KittiAverages {
  double translation_all_segments_percent = 0;   ///< over all segments of all runs: the benchmark's
  double translation_per_recording_percent = 0;  ///< mean of the recordings' own averages
  double rotation_all_segments_deg_per_m = 0;
  double rotation_per_recording_deg_per_m = 0;
  std::size_t segments = 0;
  std::size_t recordings = 0;
};

/// A pipeline at one point of its grid, over all recordings.
struct VariantSummary {
  std::string variant{};  ///< "floam solver.huber_m=0.2"
  std::string pipeline{};
  std::vector<std::string> settings{};
  std::size_t runs = 0;
  std::size_t finished = 0;
  std::size_t ok = 0;           ///< usable ones, of which
  std::size_t degraded = 0;     ///< so many are degraded
  std::size_t over_budget = 0;  ///< runs that break a budget
  /// By metric: mean over the recordings of the mean over their repeats; runs that are ok.
  std::map<std::string, double> means{};
  std::optional<KittiAverages> kitti{};
};

/// Repeats of one run, and whether they gave the same trajectory, bit for bit.
struct RepeatCheck {
  std::size_t groups = 0;     ///< combinations with at least two finished repeats
  std::size_t different = 0;  ///< of them, those whose trajectories differ
  /// Of those that differ, by how much; in the order of their names.
  struct Spread {
    std::string title;  ///< "drive_0001, floam"
    double least = 0;   ///< of the metric that was asked for, over the repeats
    double most = 0;
  };
  std::vector<Spread> spreads = {};
};

/// One summary a variant, best first: more runs that are usable, then fewer that are degraded, then
/// the lower mean of `rank_by`. A variant that fails on hard recordings is not better for it, and
/// one that is lost there has failed.
std::vector<VariantSummary> summarise(const Results& results, const std::vector<Budget>& budgets,
                                      const std::string& rank_by);

/// \param metric whose spread is told
RepeatCheck check_repeats(const Results& results, const std::string& metric);

/// The leaderboard with the given metrics and both KITTI averages.
page::Table leaderboard(const std::vector<VariantSummary>& variants,
                        const std::vector<std::string>& metrics);

}  // namespace traverse::batch
