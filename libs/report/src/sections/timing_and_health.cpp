#include <algorithm>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "charts/series.hpp"
#include "run/number_texts.hpp"
#include "sections/sections.hpp"

namespace traverse::report {

namespace {

constexpr std::size_t kWorstFrames = 10;

/// Frames in the order in which one would look at them: lost ones first, then degenerate ones, then
/// by falling residual.
std::vector<std::size_t> frames_by_concern(const pipeline::FrameTable& frames) {
  const std::vector<double> registered = frames.column("registered");
  const std::vector<double> degenerate = frames.column("degenerate_directions");
  const std::vector<double> residual = frames.column("residual_rms_m");
  std::vector<std::size_t> order(frames.rows().size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (residual.empty()) return {};
  if (!order.empty()) order.erase(order.begin());  // the first frame is registered in nothing
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (registered[a] != registered[b]) return registered[a] < registered[b];
    if (degenerate[a] != degenerate[b]) return degenerate[a] > degenerate[b];
    return residual[a] > residual[b];
  });
  order.resize(std::min(order.size(), kWorstFrames));
  return order;
}

Table worst_table(const RunData& run) {
  const pipeline::FrameTable& frames = run.frames;
  Table table(
      "worst_frames", "Frames to look at first",
      {"frame", "time [s]", "registered", "degenerate", "residual rms [m]", "inliers [%]",
       "line matches", "plane matches", "least eigenvalue", "time taken [ms]", "to see it"});
  const auto number = frames.column("frame");
  const auto stamp = frames.column("stamp_s");
  const auto registered = frames.column("registered");
  const auto degenerate = frames.column("degenerate_directions");
  const auto residual = frames.column("residual_rms_m");
  const auto inliers = frames.column("inlier_share");
  const auto lines = frames.column("line_matches");
  const auto planes = frames.column("plane_matches");
  const auto eigenvalue = frames.column("eigenvalue_1");
  const auto total = frames.column("total_ms");
  for (const std::size_t i : frames_by_concern(frames)) {
    table.add_row(
        {Cell::moment(std::to_string(static_cast<std::size_t>(number[i])), i),
         stamp[i] - stamp.front(), registered[i] != 0 ? "yes" : "no",
         Cell::count(static_cast<std::size_t>(degenerate[i])), residual[i], 100 * inliers[i],
         Cell::count(static_cast<std::size_t>(lines[i])),
         Cell::count(static_cast<std::size_t>(planes[i])), eigenvalue[i], total[i],
         fmt::format("traverse-replay {} --at {:.0f}", run.folder.path.string(), number[i])});
  }
  return table;
}

/// A row of the timing table; the mean and the percentiles are those of run.json.
std::vector<Cell> timing_row(const std::string& name, const nlohmann::json& timing,
                             const char* prefix, double mean, const pipeline::FrameTable& frames,
                             const std::string& column) {
  const auto of = [&](const char* key) {
    return timing.at(std::string(prefix) + key).get<double>();
  };
  return {name,     of("median"), mean, of("p95"), quantile_or_none(frames.column(column), 0.99),
          of("max")};
}

Table timing_table(const RunData& run) {
  const auto& timing = run.record.at("timing_ms");
  Table table("timing", "Time of the stages",
              {"stage", "median [ms]", "mean [ms]", "95 % [ms]", "99 % [ms]", "max [ms]"});
  for (const auto& stage : timing.at("stages")) {
    const std::string name = stage.at("name");
    table.add_row(timing_row(name, stage, "", stage.at("mean"), run.frames, name + "_ms"));
  }
  const auto frames = static_cast<double>(std::max<std::size_t>(1, run.frames.rows().size()));
  table.add_row(timing_row("frame", timing, "frame_", timing.at("total").get<double>() / frames,
                           run.frames, "total_ms"),
                true);
  return table;
}

}  // namespace

void add_health(const RunData& run, Model& model) {
  model.add_text("worst_how",
                 "Those that could not be registered, then those with degenerate directions, then "
                 "those with the largest residuals.");
  model.add_table(worst_table(run));
  model.page.set("frame_columns", std::to_string(run.frames.columns().size()));
}

void add_timing(const RunData& run, Model& model) {
  model.add_table(timing_table(run));
  if (run.health.is_foreign) {
    model.add_text("timing_how",
                   "As told by who ran the program that made the poses; not measured here.");
    return;
  }
  model.add_text(
      "timing_how",
      fmt::format("Wall time of the estimator on {}; reading the recording, maps and "
                  "evaluation are not in it. The whole run took {}, {} MB of memory at most.",
                  plural(run.record.at("threads"), "thread"),
                  duration_text(run.record.at("wall_seconds")),
                  short_number(run.record.at("peak_memory_mb").get<double>())));
}

}  // namespace traverse::report
