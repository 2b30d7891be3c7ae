#include "evaluation_check.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"

namespace traverse::pipeline {

namespace {

using evaluation::Comparison;
using evaluation::Statistics;
using evaluation::TrajectoryFacts;
using files::InputError;
using files::Place;

constexpr double kLargest = 1e100;        // squares and sums of such are still numbers
constexpr double kSameLength = 1e-9;      // relative: the same sum of the same bits
constexpr double kLargestError_m = 1e10;  // of a shift between two maps
constexpr double kLargestScale = 1e6;

class EvaluationCheck {
 public:
  explicit EvaluationCheck(const std::filesystem::path& file) : file_(file) {}

  /// \param key of the facts \param name of the trajectory's file
  void require_facts(const std::string& key, const TrajectoryFacts& facts,
                     const geometry::Trajectory& trajectory, const std::string& name) const {
    if (facts.poses != trajectory.size()) {
      fail(key + ".poses", fmt::format("the {} poses of {}", trajectory.size(), name),
           std::to_string(facts.poses));
    }
    const double length_m = trajectory.path_length();
    if (!(std::abs(facts.path_m - length_m) <= kSameLength * (1 + length_m))) {
      fail(key + ".path_m", fmt::format("the length of {}, {} m", name, length_m),
           fmt::format("{} m", facts.path_m));
    }
    if (facts.first != trajectory.stamps().front() || facts.last != trajectory.stamps().back()) {
      fail(key, fmt::format("the first and the last stamp of {}", name), "others");
    }
  }

  void require_matches(const Comparison& comparison, const geometry::Trajectory& estimate) const {
    const std::string key = "association.per_pair";
    if (comparison.association.mode != evaluation::AssociationMode::kStamp) {
      fail("association.by", "stamp", "index");
    }
    const auto& matches = comparison.association.matches;
    if (matches.empty()) fail("association.pairs", "at least one pair", "none");
    for (std::size_t k = 0; k < matches.size(); ++k) {
      if (matches[k].estimate >= estimate.size()) {
        fail(key + ".estimate", fmt::format("numbers of the {} poses", estimate.size()),
             std::to_string(matches[k].estimate));
      }
      if (matches[k].reference >= comparison.reference.poses) {
        fail(key + ".reference",
             fmt::format("numbers of the {} poses of the reference", comparison.reference.poses),
             std::to_string(matches[k].reference));
      }
      if (comparison.stamps[k] != estimate.stamp(matches[k].estimate)) {
        fail(key + ".stamp_ns",
             fmt::format("the stamp of pose {}, {}", matches[k].estimate,
                         estimate.stamp(matches[k].estimate).nanoseconds),
             std::to_string(comparison.stamps[k].nanoseconds));
      }
      require_number(key + ".time_difference_s", matches[k].time_difference_s);
    }
    require_numbers(key + ".distance_m", comparison.distances_m);
  }

  void require_alignment(const evaluation::Alignment& alignment) const {
    const bool is_near =
        alignment.T_reference_estimate.translation.cwiseAbs().maxCoeff() <= kLargestError_m;
    const bool is_like = alignment.scale <= kLargestScale && alignment.scale >= 1 / kLargestScale;
    if (!is_near || !is_like) fail("alignment", "an alignment of two drives", "larger numbers");
  }

  void require_errors(const std::string& key, const Statistics& statistics,
                      std::span<const double> values) const {
    if (statistics.count != values.size()) {
      fail(key + ".count", fmt::format("the number of values, {}", values.size()),
           std::to_string(statistics.count));
    }
    require_numbers(key, values);
    for (const double value : {statistics.rmse, statistics.mean, statistics.median, statistics.std,
                               statistics.min, statistics.max}) {
      require_number(key, value);
    }
  }

  void require_comparison(const Comparison& comparison) const {
    for (const auto& ape : comparison.ape) require_errors("ape", ape.statistics, ape.values);
    for (const auto& ape : comparison.ape_at_origin) {
      require_errors("ape_at_origin", ape.statistics, ape.values);
    }
    for (const auto& rpe : comparison.rpe) require_errors("rpe", rpe.statistics, rpe.values);
    const auto& path = comparison.path;
    for (const double value : {path.estimate_m, path.reference_m, path.end_error_m,
                               path.end_error_percent.value_or(0), path.end_rotation_deg}) {
      require_number("path", value);
    }
    if (!comparison.kitti) return;
    require_number("kitti", comparison.kitti->translation_percent);
    require_number("kitti", comparison.kitti->rotation_deg_per_m);
    for (const auto* bins : {&comparison.kitti->by_length, &comparison.kitti->by_speed}) {
      for (const auto& bin : *bins) {
        for (const double value : {bin.centre, bin.translation_percent, bin.rotation_deg_per_m}) {
          require_number("kitti", value);
        }
      }
    }
    for (const auto& segment : comparison.kitti->segments) {
      for (const double value : {segment.translation_percent, segment.rotation_deg_per_m}) {
        require_number("kitti.per_segment", value);
      }
      if (!(segment.length_m >= 0 && segment.length_m <= kLargestError_m)) {
        fail("kitti.per_segment.length_m", "lengths in metres",
             fmt::format("{}", segment.length_m));
      }
    }
  }

  void require_number(const std::string& key, double value) const {
    if (std::abs(value) <= kLargest) return;
    fail(key, fmt::format("numbers up to {:.0e}", kLargest), fmt::format("{}", value));
  }
  void require_numbers(const std::string& key, std::span<const double> values) const {
    for (const double value : values) require_number(key, value);
  }

 private:
  [[noreturn]] void fail(const std::string& key, const std::string& expected,
                         const std::string& found) const {
    throw InputError(file_, Place::key(key), expected, found);
  }

  const std::filesystem::path& file_;
};

}  // namespace

void require_evaluation(const evaluation::Evaluation& evaluation, const std::filesystem::path& file,
                        const geometry::Trajectory& estimate,
                        const std::filesystem::path& estimate_file,
                        const std::optional<geometry::Trajectory>& reference) {
  const EvaluationCheck check(file);
  check.require_facts("estimate", evaluation.estimate, estimate, estimate_file.filename().string());
  if (evaluation.consistency) {
    check.require_number("consistency.mme", evaluation.consistency->mme);
    check.require_number("consistency.mpv_m", evaluation.consistency->mpv_m);
  }
  if (!evaluation.comparison) return;
  const Comparison& comparison = *evaluation.comparison;
  if (reference)
    check.require_facts("reference", comparison.reference, *reference, "reference.tum");
  check.require_matches(comparison, estimate);
  check.require_alignment(comparison.alignment);
  check.require_comparison(comparison);
}

}  // namespace traverse::pipeline
