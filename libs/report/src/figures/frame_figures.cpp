#include "figures/frame_figures.hpp"

#include <fmt/format.h>

#include "traverse/render/pictures/stage_times.hpp"
#include "traverse/render/pictures/time_series.hpp"

#include "charts/series.hpp"
#include "figures/navigation_figures.hpp"
#include "run/number_texts.hpp"

namespace traverse::report {

using render::Style;

void add_health_figures(const RunData& run, FigureMaker& maker) {
  if (!run.frames.has("residual_rms_m")) return;
  const std::vector<double> times = seconds_from_start(run);
  // The first frame is registered in nothing: its zeros are no measurements.
  const auto column = [&](const char* name) {
    std::vector<double> values = run.frames.column(name);
    if (!values.empty()) values.front() = kNone;
    return values;
  };
  const std::vector<double> residual = column("residual_rms_m");
  std::vector<double> inliers = column("inlier_share");
  for (double& value : inliers) value *= 100;
  const std::vector<double> lines = column("line_matches");
  const std::vector<double> planes = column("plane_matches");
  const std::vector<double> eigenvalue = column("eigenvalue_1");

  render::TimeSeries series;
  series.panels.push_back({"residual rms", "m", {{"", times, residual}}, {}});
  series.panels.push_back({"inliers", "%", {{"", times, inliers}}, {}});
  series.panels.push_back(
      {"matches", "", {{"lines", times, lines}, {"planes", times, planes}}, {}});
  series.panels.push_back({"least eigenvalue", "", {{"", times, eigenvalue}}, {}});
  const auto degenerate = spans_where(times, run.frames.column("degenerate_directions"));
  if (!degenerate.empty()) series.shaded.push_back({"degenerate", degenerate});
  maker.add(
      "health", "health-over-time",
      "Registration frame by frame: what is left between points and their lines and planes, "
      "how many of the matches agree, how many there are, and how well the worst direction of "
      "motion is determined.",
      [&](const Style& style) {
        return render::time_series(
            series,
            maker.caption("Health over time", fmt::format("{} frames", run.frames.rows().size())),
            style);
      },
      "charts");
}

void add_timing_figures(const RunData& run, FigureMaker& maker) {
  const auto& timing = run.record.at("timing_ms");
  const std::string statistic =
      fmt::format("median {} ms, 95 % {} ms", short_number(timing.at("frame_median").get<double>()),
                  short_number(timing.at("frame_p95").get<double>()));
  std::vector<render::StageTime> stages;
  for (const auto& stage : timing.at("stages")) {
    if (stage.at("median").get<double>() == 0) continue;  // once a run, not once a frame
    stages.push_back({stage.at("name"), stage.at("median"), stage.at("p95")});
  }
  const render::StageTime frame{"frame", timing.at("frame_median"), timing.at("frame_p95")};
  maker.add("timing", "timing-stages", "Where the time of a frame goes: median and 95 %.",
            [&](const Style& style) {
              return render::stage_times(stages, frame,
                                         maker.caption("Time of the stages", statistic), style);
            });
}

}  // namespace traverse::report
