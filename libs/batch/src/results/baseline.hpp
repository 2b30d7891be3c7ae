#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "traverse/batch/results.hpp"

namespace traverse::batch {

enum class Verdict { kImproved, kNoChange, kRegressed };
std::string_view name_of(Verdict verdict);  ///< "improved", "no change", "regressed"

/// How a metric of a variant changed against the baseline, over the recordings that both have.
struct Change {
  std::string variant;
  std::string metric;
  std::size_t recordings = 0;
  double before = 0;  ///< mean over those recordings
  double now = 0;
  double change_percent = 0;  ///< of `before`
  /// 95 % interval of the mean difference, in percent of `before`; nothing for one recording.
  std::optional<std::pair<double, double>> interval_percent;
  Verdict verdict = Verdict::kNoChange;
};

/// How many runs of a variant are ok, before and now, of those that both batches have.
struct OkChange {
  std::string variant{};
  std::size_t runs = 0;
  std::size_t before = 0;
  std::size_t now = 0;
  Verdict verdict = Verdict::kNoChange;
};

struct BaselineComparison {
  std::string source;  ///< the baseline's file
  std::vector<OkChange> ok;
  std::vector<Change> changes;
  std::size_t unmatched = 0;  ///< runs of this batch that the baseline does not have
};

/// The rule, as reports state it.
extern const char* const kBaselineRule;

/// The verdict on paired values, one pair a recording, lower being better: the mean difference must
/// be at least 1 % of the mean before (10 % for times and memory, which vary from run to run), and,
/// for two and more pairs, zero must lie outside the 95 % interval of the mean difference
/// (Student's t for paired samples, n - 1 degrees of freedom).
Change judge_change(const std::vector<std::pair<double, double>>& before_and_now,
                    bool is_measured_time);

/// The results of an earlier batch, read once: the batch that compares with them may write over
/// them.
class Baseline {
 public:
  /// \param baseline a batch's folder or its results.json
  /// \throws files::InputError
  explicit Baseline(const std::filesystem::path& baseline);

  BaselineComparison compare(const Results& results, const std::vector<std::string>& metrics) const;

 private:
  struct Run {
    bool ok = false;
    std::map<std::string, double> metrics;
  };
  std::filesystem::path file_;
  std::map<std::tuple<std::string, std::string, int>, Run> runs_;  ///< recording, variant, repeat
};

}  // namespace traverse::batch
