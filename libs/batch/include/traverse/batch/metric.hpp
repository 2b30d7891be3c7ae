#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace traverse::batch {

/// A figure that a run can have.
struct Metric {
  std::string key;                ///< "ape_translation_rmse": column of results.csv, name in plans
  std::string title;              ///< "APE": head of the report's columns
  std::string unit;               ///< "m", "deg", "ms", or empty
  bool lower_is_better = true;    ///< else it is a count or a length, and nothing is better
  bool is_measured_time = false;  ///< of the machine, other on every repeat; so is memory
  bool higher_is_better = false;  ///< then a budget is the least that it may be
};

/// Lengths of stretches by which runs tell their drift: metres of KITTI's, percent of the
/// reference's path of rpg's.
inline constexpr std::array<int, 8> kKittiLengths_m{100, 200, 300, 400, 500, 600, 700, 800};
inline constexpr std::array<int, 5> kPathShares_percent{10, 20, 30, 40, 50};
std::string kitti_length_key(int length_m);     ///< "kitti_100m_translation_percent"
std::string path_share_key(int share_percent);  ///< "rpg_10_translation_percent_mean"

/// Every metric, in the order of the columns of results.csv.
const std::vector<Metric>& known_metrics();
/// The metric of that key, or nullptr.
const Metric* find_metric(std::string_view key);
/// "APE [m]"
std::string with_unit(const Metric& metric);
/// What a report shows when the plan does not say.
std::vector<std::string> default_metrics();

/// The metrics that a run folder has, in the order of known_metrics(); what is not defined is left
/// out. Missing or broken files give none.
std::vector<std::pair<std::string, double>> read_metrics(const std::filesystem::path& run_folder);

}  // namespace traverse::batch
