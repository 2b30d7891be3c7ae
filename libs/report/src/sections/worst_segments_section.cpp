#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "charts/series.hpp"
#include "sections/sections.hpp"

namespace traverse::report {

void add_worst_segments(const RunData& run, const evaluation::WorstSegments& worst, Model& model) {
  Table table("worst_segments", "The worst segments",
              {"from frame", "to frame", "from [s]", "length [m]",
               fmt::format("{} [{}]", worst.measure, worst.unit), "least eigenvalue",
               "degenerate frames", "inliers [%]"});
  const auto number = run.frames.column("frame");
  const auto eigenvalue = run.frames.column("eigenvalue_1");
  const auto degenerate = run.frames.column("degenerate_directions");
  const auto inliers = run.frames.column("inlier_share");
  const std::vector<double> times = seconds_from_start(run);
  const std::vector<double> path_m = run.estimate.accumulated_distances();
  const auto over = [](const std::vector<double>& column, const evaluation::WorstSegment& s) {
    // The errors of a motion are made after its first frame.
    const auto begin = column.begin() + static_cast<std::ptrdiff_t>(s.first + 1);
    return std::vector<double>(begin, column.begin() + static_cast<std::ptrdiff_t>(s.last + 1));
  };
  for (const evaluation::WorstSegment& s : worst.segments) {
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
      fmt::format("By {}{}; none overlaps a worse one. A click on a frame takes the charts "
                  "and the 3-D view there.",
                  worst.measure,
                  run.evaluation.comparison
                      ? ", the median of five pairs that begin one frame after the other, so that "
                        "no single pose that jitters makes a segment"
                      : ""));
}

}  // namespace traverse::report
