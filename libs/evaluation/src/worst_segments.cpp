#include "traverse/evaluation/worst_segments.hpp"

#include <algorithm>
#include <cmath>

#include "traverse/statistics/quantile.hpp"

namespace traverse::evaluation {

namespace {

constexpr std::size_t kSegments = 5;
constexpr std::size_t kFrames = 10;

/// The median of a value and its two neighbours on each side. One pose of the reference that is
/// off, or a stamp, makes one value large; a stretch that is bad makes all of them.
double median_about(std::span<const double> values, std::size_t k) {
  constexpr std::size_t kBeside = 2;
  const std::size_t first = k < kBeside ? 0 : k - kBeside;
  const std::size_t last = std::min(values.size(), k + kBeside + 1);
  return statistics::median(values.subspan(first, last - first));
}

std::vector<WorstSegment> by_relative_error(const Comparison& comparison, const Rpe& rpe) {
  const auto& matches = comparison.association.matches;
  std::vector<WorstSegment> all;
  for (std::size_t k = 0; k < rpe.pairs.size(); ++k) {
    all.push_back({matches[rpe.pairs[k].from].estimate, matches[rpe.pairs[k].to].estimate,
                   median_about(rpe.values, k)});
  }
  return all;
}

std::vector<WorstSegment> by_residual(std::span<const double> residual_rms_m) {
  std::vector<WorstSegment> all;
  for (std::size_t first = 0; first + kFrames < residual_rms_m.size(); ++first) {
    double squares = 0;
    for (const double residual : residual_rms_m.subspan(first + 1, kFrames)) {
      squares += residual * residual;
    }
    const double rms = std::sqrt(squares / kFrames);
    if (std::isfinite(rms)) all.push_back({first, first + kFrames, rms});
  }
  return all;
}

/// The largest that do not overlap a larger one.
std::vector<WorstSegment> largest_apart(std::vector<WorstSegment> all) {
  std::stable_sort(all.begin(), all.end(),
                   [](const WorstSegment& a, const WorstSegment& b) { return a.value > b.value; });
  std::vector<WorstSegment> chosen;
  for (const WorstSegment& segment : all) {
    if (chosen.size() == kSegments) break;
    const bool apart = std::none_of(chosen.begin(), chosen.end(), [&](const WorstSegment& other) {
      return segment.first <= other.last && other.first <= segment.last;
    });
    if (apart) chosen.push_back(segment);
  }
  return chosen;
}

}  // namespace

WorstSegments worst_segments(const Evaluation& evaluation, std::span<const double> residual_rms_m) {
  const Rpe* rpe = evaluation.comparison
                       ? find_rpe(*evaluation.comparison, Relation::kTranslation, kFrames)
                       : nullptr;
  if (rpe != nullptr) {
    return {"RPE over 10 frames", "m",
            largest_apart(by_relative_error(*evaluation.comparison, *rpe))};
  }
  return {"residual rms over 10 frames", "m", largest_apart(by_residual(residual_rms_m))};
}

}  // namespace traverse::evaluation
