#include "worst_segments.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "series.hpp"

namespace traverse::report {

namespace {

constexpr std::size_t kSegments = 5;
constexpr double kFrames = 10;

std::vector<WorstSegment> by_relative_error(const RunData& run, const evaluation::Rpe& rpe) {
  const auto& matches = run.evaluation.comparison->association.matches;
  std::vector<WorstSegment> all;
  for (std::size_t k = 0; k < rpe.pairs.size(); ++k) {
    all.push_back(
        {matches[rpe.pairs[k].from].estimate, matches[rpe.pairs[k].to].estimate, rpe.values[k]});
  }
  return all;
}

std::vector<WorstSegment> by_residual(const pipeline::FrameTable& frames) {
  const std::vector<double> residual = frames.column("residual_rms_m");
  constexpr auto kLength = static_cast<std::size_t>(kFrames);
  std::vector<WorstSegment> all;
  for (std::size_t first = 0; first + kLength < residual.size(); ++first) {
    double squares = 0;
    for (std::size_t i = first + 1; i <= first + kLength; ++i) squares += residual[i] * residual[i];
    all.push_back({first, first + kLength, std::sqrt(squares / kFrames)});
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

WorstSegments worst_segments(const RunData& run) {
  const evaluation::Rpe* rpe =
      run.evaluation.comparison
          ? find_rpe(*run.evaluation.comparison, evaluation::Relation::kTranslation, kFrames)
          : nullptr;
  if (rpe != nullptr) {
    return {"RPE over 10 frames", "m", largest_apart(by_relative_error(run, *rpe))};
  }
  return {"residual rms over 10 frames", "m", largest_apart(by_residual(run.frames))};
}

void add_worst_segments(const RunData& run, const WorstSegments& worst, Model& model) {
  HtmlTable table("worst_segments", "The worst segments",
                  {"from frame", "to frame", "from [s]", "length [m]",
                   fmt::format("{} [{}]", worst.measure, worst.unit), "least eigenvalue",
                   "degenerate frames", "inliers [%]"});
  const auto number = run.frames.column("frame");
  const auto eigenvalue = run.frames.column("eigenvalue_1");
  const auto degenerate = run.frames.column("degenerate_directions");
  const auto inliers = run.frames.column("inlier_share");
  const std::vector<double> times = seconds_from_start(run);
  const std::vector<double> path_m = run.estimate.accumulated_distances();
  const auto over = [](const std::vector<double>& column, const WorstSegment& s) {
    // The errors of a motion are made after its first frame.
    const auto begin = column.begin() + static_cast<std::ptrdiff_t>(s.first + 1);
    return std::vector<double>(begin, column.begin() + static_cast<std::ptrdiff_t>(s.last + 1));
  };
  for (const WorstSegment& s : worst.segments) {
    std::vector<Cell> cells{
        Cell::moment(std::to_string(static_cast<std::size_t>(number[s.first])), s.first),
        Cell::moment(std::to_string(static_cast<std::size_t>(number[s.last])), s.last),
        times[s.first], path_m[s.last] - path_m[s.first], s.value};
    if (eigenvalue.empty()) {
      for (int k = 0; k < 3; ++k) cells.emplace_back("–");
    } else {
      const auto least = over(eigenvalue, s);
      const auto directions = over(degenerate, s);
      const auto shares = over(inliers, s);
      cells.emplace_back(*std::min_element(least.begin(), least.end()));
      cells.push_back(Cell::count(static_cast<std::size_t>(std::count_if(
          directions.begin(), directions.end(), [](double count) { return count > 0; }))));
      cells.emplace_back(100 * std::accumulate(shares.begin(), shares.end(), 0.0) /
                         static_cast<double>(shares.size()));
    }
    table.add_row(std::move(cells));
  }
  model.add_table(table);
  model.add_text(
      "worst_segments_how",
      fmt::format("By {}; none overlaps a worse one. A click on a frame takes the charts "
                  "and the 3-D view there.",
                  worst.measure));
}

}  // namespace traverse::report
