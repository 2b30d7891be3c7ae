#include "figures/run_figures.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "traverse/evaluation/titles.hpp"

#include "charts/navigation_series.hpp"
#include "charts/series.hpp"
#include "run/number_texts.hpp"

namespace traverse::report {

namespace {

using evaluation::Comparison;
using evaluation::Relation;

RunFigure figure(std::string_view id, double value, std::string how, std::string no_interval) {
  for (const FigureKind& kind : figure_kinds()) {
    if (kind.id != id) continue;
    RunFigure result;
    result.id = id;
    result.label = kind.label;
    result.unit = kind.unit;
    result.higher_is_better = kind.higher_is_better;
    result.how = std::move(how);
    result.value = value;
    result.no_interval = std::move(no_interval);
    return result;
  }
  throw std::invalid_argument(fmt::format("no figure is called {}", id));
}

/// With the interval of `values`, which are in the order of time.
RunFigure figure_of_values(std::string_view id, double value, std::string how,
                           const std::vector<double>& values, evaluation::Figure kind) {
  RunFigure result = figure(id, value, std::move(how), {});
  result.interval = evaluation::bootstrap_interval(values, kind);
  if (!result.interval) {
    result.no_interval = fmt::format("{}, too few for an interval", plural(values.size(), "value"));
  }
  return result;
}

void add_path(const Comparison& comparison, std::vector<RunFigure>& figures) {
  const evaluation::PathFigures& path = comparison.path;
  const std::string percent =
      path.end_error_percent ? fmt::format(", {} %", short_number(*path.end_error_percent)) : "";
  const std::string how =
      fmt::format("distance of the end points where the first poses coincide{} of {} m", percent,
                  short_number(path.reference_m));
  const std::string single = "one end point: its scatter is not known";
  figures.push_back(figure("closing_error_m", path.end_error_m, how, single));
  if (path.end_error_percent) {
    figures.push_back(figure("closing_error_percent", *path.end_error_percent, how, single));
  }
}

void add_ape(const Comparison& comparison, std::vector<RunFigure>& figures) {
  for (const auto& [id, relation] : {std::pair{"ape_rmse_m", Relation::kTranslation},
                                     std::pair{"ape_angle_rmse_deg", Relation::kAngleDeg}}) {
    const auto* ape = find_ape(comparison, relation);
    if (ape == nullptr) continue;
    const std::string how = fmt::format(
        "rmse, {}, {} pairs", evaluation::describe(comparison.alignment, ape->statistics.count),
        ape->statistics.count);
    figures.push_back(
        figure_of_values(id, ape->statistics.rmse, how, ape->values, evaluation::Figure::kRmse));
  }
}

void add_relative(const Comparison& comparison, std::vector<RunFigure>& figures) {
  if (const auto& kitti = comparison.kitti) {
    std::vector<double> translation;
    std::vector<double> rotation;
    for (const auto& segment : kitti->segments) {
      translation.push_back(segment.translation_percent);
      rotation.push_back(100 * segment.rotation_deg_per_m);
    }
    const std::string how = fmt::format("KITTI: mean over {} of 100 to 800 m, {} frame",
                                        plural(kitti->segments.size(), "segment"), kitti->frame);
    figures.push_back(figure_of_values("kitti_translation_percent", kitti->translation_percent, how,
                                       translation, evaluation::Figure::kMean));
    figures.push_back(figure_of_values("kitti_rotation_deg_per_100m",
                                       100 * kitti->rotation_deg_per_m, how, rotation,
                                       evaluation::Figure::kMean));
  }
  if (const auto* rpe = find_rpe(comparison, Relation::kTranslation, 10)) {
    figures.push_back(figure_of_values("rpe_10_frames_rmse_m", rpe->statistics.rmse,
                                       fmt::format("rmse, {} pairs", rpe->statistics.count),
                                       rpe->values, evaluation::Figure::kRmse));
  }
}

/// How smooth a navigated path is, at the fixes, where it jumps if it does.
void add_jumps(const RunData& run, std::vector<RunFigure>& figures) {
  const auto finite = [](std::vector<double> values) {
    std::erase_if(values, [](double value) { return !std::isfinite(value); });
    return values;
  };
  const std::vector<double> jumps = finite(at_fixes(run.frames, "correction_m"));
  if (!jumps.empty()) {
    const auto many =
        std::count_if(jumps.begin(), jumps.end(), [](double jump) { return jump > kJump_m; });
    const std::string of = fmt::format("of {} at fixes", plural(jumps.size(), "step"));
    figures.push_back(
        figure_of_values("jump_p95_m", evaluation::figure_of(jumps, evaluation::Figure::kP95),
                         "step of the path less the predicted one, 95th percentile " + of, jumps,
                         evaluation::Figure::kP95));
    figures.push_back(figure("jump_max_m", *std::max_element(jumps.begin(), jumps.end()),
                             "step of the path less the predicted one, the largest " + of,
                             "one value: its scatter is not known"));
    figures.push_back(figure("jumps", static_cast<double>(many),
                             fmt::format("more than {} m off the predicted step, {}", kJump_m, of),
                             "a count, exact"));
  }
  const std::vector<double> roughness = finite(at_fixes(run.frames, "roughness_m"));
  if (roughness.empty()) return;
  figures.push_back(figure_of_values(
      "roughness_m", evaluation::figure_of(roughness, evaluation::Figure::kRmse),
      fmt::format("second difference of the places at fixes less what the velocities account for, "
                  "rms of {}",
                  plural(roughness.size(), "value")),
      roughness, evaluation::Figure::kRmse));
}

/// How far off a run was when fixes came again.
void add_outages(const RunData& run, std::vector<RunFigure>& figures) {
  std::vector<double> errors;
  for (const double error : run.frames.column("outage_error_m")) {
    if (error > 0) errors.push_back(error);
  }
  if (errors.empty()) return;
  figures.push_back(figure_of_values(
      "outage_error_rms_m", evaluation::figure_of(errors, evaluation::Figure::kRmse),
      fmt::format("rms over {}: horizontal, to the first fix after it",
                  plural(errors.size(), "GNSS outage")),
      errors, evaluation::Figure::kRmse));
}

/// What an estimator tells of its frames: nothing is known of another program's.
void add_registration(const RunData& run, std::vector<RunFigure>& figures) {
  const std::string exact = "a count, exact";
  if (const auto share = run.health.registered_share()) {
    figures.push_back(figure("registered_share", *share,
                             fmt::format("{} of {}", count_text(run.health.registered),
                                         plural(run.health.registrable, "frame")),
                             exact));
  }
  figures.push_back(figure("restarts", static_cast<double>(run.health.restarts),
                           "times that the estimator began again", exact));
  figures.push_back(figure("lost_frames", static_cast<double>(run.health.lost.frames),
                           "frames that could not be registered, after the first", exact));
  figures.push_back(figure("degenerate_frames", static_cast<double>(run.health.degenerate.frames),
                           "frames with a direction of motion that is not determined", exact));
}

void add_health(const RunData& run, std::vector<RunFigure>& figures) {
  const std::string exact = "a count, exact";
  if (!run.health.is_foreign) add_registration(run, figures);
  figures.push_back(figure("skipped_records", static_cast<double>(skipped_records(run.record)),
                           "records that could not be used", exact));
}

void add_frame_times(const RunData& run, const nlohmann::json& timing, const std::string& on,
                     const std::string& single, std::vector<RunFigure>& figures) {
  figures.push_back(
      figure_of_values("frame_median_ms", timing.at("frame_median"),
                       fmt::format("median, {} at 95 %, {}; quantiles linear between ranks",
                                   short_number(timing.at("frame_p95").get<double>()), on),
                       run.frames.column("total_ms"), evaluation::Figure::kMedian));
  figures.push_back(figure("frame_p95_ms", timing.at("frame_p95"),
                           "95th percentile, linear between ranks, " + on, single));
  figures.push_back(figure("frame_max_ms", timing.at("frame_max"), "the slowest, " + on, single));
}

void add_cost(const RunData& run, std::vector<RunFigure>& figures) {
  const auto& timing = run.record.at("timing_ms");
  const auto& threads = run.record.at("threads");
  const std::string on = threads.is_null() ? "threads not known" : plural(threads, "thread");
  const std::string single =
      run.health.is_foreign ? "told by who ran the other program" : "one measurement of this run";
  if (!timing.is_null()) add_frame_times(run, timing, on, single, figures);
  if (const auto& wall_s = run.record.at("wall_seconds"); !wall_s.is_null()) {
    figures.push_back(figure("wall_seconds", wall_s, "the whole run, " + on, single));
  }
  if (const auto& peak_mb = run.record.at("peak_memory_mb"); !peak_mb.is_null()) {
    figures.push_back(figure("peak_memory_mb", peak_mb, "of the whole run", single));
  }
}

}  // namespace

const std::vector<FigureKind>& figure_kinds() {
  static const std::vector<FigureKind> kinds{
      {"kitti_translation_percent", "Drift", "%", "KITTI: mean over segments of 100 to 800 m"},
      {"kitti_rotation_deg_per_100m", "Rotation drift", "deg/100 m", "the same of the rotation"},
      {"closing_error_m", "Closing error", "m",
       "distance of the last poses where the first coincide"},
      {"closing_error_percent", "Closing error", "%",
       "the same in percent of the reference's path, from 10 m on"},
      {"outage_error_rms_m", "Error after outages", "m",
       "horizontal, to the first fix after each GNSS outage, rms"},
      {"jump_p95_m", "Jump at fixes, 95 %", "m", "step of the path less the predicted one"},
      {"jump_max_m", "Largest jump", "m", "the largest of it"},
      {"jumps", "Jumps", "", "steps that are more than 0.05 m off the predicted ones"},
      {"roughness_m", "Roughness", "m",
       "second difference of the path at fixes less what its velocities account for, rms"},
      {"ape_rmse_m", "APE", "m", "absolute pose error, translation, rmse"},
      {"ape_angle_rmse_deg", "APE, angle", "deg", "absolute pose error, rotation, rmse"},
      {"rpe_10_frames_rmse_m", "RPE over 10 frames", "m", "relative pose error, rmse"},
      {"map_entropy_nats", "Map entropy", "nats", "mean map entropy; lower is sharper"},
      {"registered_share", "Registered", "",
       "frames whose pose rests on a measurement, of those that could", true},
      {"restarts", "Restarts", "", "times that the estimator gave up what it knew and began again"},
      {"lost_frames", "Lost frames", "", "frames that could not be registered"},
      {"degenerate_frames", "Degenerate frames", "", "frames that do not determine their motion"},
      {"skipped_records", "Skipped records", "", "records that could not be used"},
      {"frame_median_ms", "Time per frame", "ms", "median time of the estimator"},
      {"frame_p95_ms", "Time per frame, 95 %", "ms", "95th percentile of it"},
      {"frame_max_ms", "Slowest frame", "ms", "the largest of it"},
      {"wall_seconds", "Whole run", "s", "wall time of the run with its maps and evaluation"},
      {"peak_memory_mb", "Memory", "MB", "largest memory of the run"}};
  return kinds;
}

std::vector<RunFigure> accuracy_figures(const evaluation::Evaluation& evaluation) {
  std::vector<RunFigure> figures;
  if (const auto& comparison = evaluation.comparison) {
    add_relative(*comparison, figures);
    add_ape(*comparison, figures);
    add_path(*comparison, figures);
  }
  if (const auto& score = evaluation.consistency) {
    figures.push_back(figure("map_entropy_nats", score->mme,
                             fmt::format("mean of {} queries, lower is sharper; points {}",
                                         count_text(score->queries), score->points_are),
                             "only its mean is kept"));
  }
  return figures;
}

std::vector<RunFigure> run_figures(const RunData& run) {
  std::vector<RunFigure> figures = accuracy_figures(run.evaluation);
  add_outages(run, figures);
  add_jumps(run, figures);
  add_health(run, figures);
  add_cost(run, figures);
  return figures;
}

const RunFigure* find_figure(const std::vector<RunFigure>& figures, std::string_view id) {
  const auto found = std::find_if(figures.begin(), figures.end(),
                                  [&](const RunFigure& item) { return item.id == id; });
  return found == figures.end() ? nullptr : &*found;
}

}  // namespace traverse::report
