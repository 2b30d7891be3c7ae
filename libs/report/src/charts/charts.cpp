#include "charts/charts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "charts/chart.hpp"
#include "charts/covariance_charts.hpp"
#include "charts/series.hpp"

namespace traverse::report {

namespace {

using evaluation::Relation;

std::vector<std::size_t> matched_poses(const evaluation::Comparison& comparison) {
  std::vector<std::size_t> poses;
  for (const auto& match : comparison.association.matches) poses.push_back(match.estimate);
  return poses;
}

void add_absolute(const evaluation::Comparison& comparison, Json& charts) {
  const auto poses = matched_poses(comparison);
  for (const auto& [id, title, relation] :
       {std::tuple{"ape", "APE, position", Relation::kTranslation},
        std::tuple{"ape-angle", "APE, angle", Relation::kAngleDeg}}) {
    const auto* ape = find_ape(comparison, relation);
    if (ape == nullptr) continue;
    charts.push_back(Chart(id, "error", title, std::string(evaluation::unit_of(relation)))
                         .series("error", ape->values)
                         .poses(poses)
                         .level("rmse", ape->statistics.rmse)
                         .take());
  }
}

void add_relative(const evaluation::Comparison& comparison, Json& charts) {
  const auto* rpe = find_rpe(comparison, Relation::kTranslation, 10);
  if (rpe == nullptr) return;
  std::vector<std::size_t> poses;
  for (const auto& pair : rpe->pairs) {
    poses.push_back(comparison.association.matches[pair.to].estimate);
  }
  charts.push_back(Chart("rpe", "error", "RPE over 10 frames", "m")
                       .series("error", rpe->values)
                       .poses(poses)
                       .level("rmse", rpe->statistics.rmse)
                       .take());
}

/// Share of the poses up to each error; a point still belongs to its pose.
void add_share(const evaluation::Comparison& comparison, Json& charts) {
  const auto* ape = find_ape(comparison, Relation::kTranslation);
  if (ape == nullptr) return;
  const auto matched = matched_poses(comparison);
  std::vector<std::size_t> order(ape->values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return ape->values[a] < ape->values[b]; });
  std::vector<double> errors;
  std::vector<double> shares;
  std::vector<std::size_t> poses;
  for (std::size_t k = 0; k < order.size(); ++k) {
    errors.push_back(ape->values[order[k]]);
    shares.push_back(100 * static_cast<double>(k + 1) / static_cast<double>(order.size()));
    poses.push_back(matched[order[k]]);
  }
  charts.push_back(Chart("ecdf", "error", "Share of the poses up to each error (ECDF)", "%")
                       .series("share", shares)
                       .poses(poses)
                       .x("APE, position [m]", errors)
                       .take());
}

void add_kitti(const evaluation::KittiDrift& kitti, Json& charts) {
  for (const auto& [id, name, bins] : {std::tuple{"kitti-length", "length [m]", &kitti.by_length},
                                       std::tuple{"kitti-speed", "speed [m/s]", &kitti.by_speed}}) {
    if (bins->size() < 2) continue;
    std::vector<double> centres;
    std::vector<double> translation;
    std::vector<double> rotation;
    for (const auto& bin : *bins) {
      centres.push_back(bin.centre);
      translation.push_back(bin.translation_percent);
      rotation.push_back(100 * bin.rotation_deg_per_m);
    }
    charts.push_back(Chart(id, "kitti", std::string("KITTI drift by ") + name, "")
                         .series("translation [%]", translation)
                         .series("rotation [deg/100 m]", rotation)
                         .x(name, centres)
                         .flag("points")
                         .take());
  }
}

/// When poses of the estimate found a partner, and how far off in time.
void add_association(const RunData& run, Json& charts) {
  const auto& matches = run.evaluation.comparison->association.matches;
  std::vector<double> differences_ms;
  for (const auto& match : matches) differences_ms.push_back(1000 * match.time_difference_s);
  charts.push_back(
      Chart("association", "association", "Time from each pose to its match on the reference", "ms")
          .series("estimate − reference", for_each_pose(run, differences_ms))
          .flag("points")
          .take());
}

struct Column {
  const char* name;
  const char* column;
};

/// A chart of columns of frames.csv, as far as this kind of estimator has them. The first frame is
/// registered in nothing: where `from_second`, its zeros are no measurements.
void add_columns(const pipeline::FrameTable& frames, Chart chart,
                 const std::vector<Column>& columns, bool from_second, double factor,
                 Json& charts) {
  bool any = false;
  for (const auto& [name, column] : columns) {
    std::vector<double> values = frames.column(column);
    if (values.empty()) continue;
    for (double& value : values) value *= factor;
    if (from_second) values.front() = kNone;
    chart.series(name, values);
    any = true;
  }
  if (any) charts.push_back(chart.take());
}

}  // namespace

void add_error_charts(const RunData& run, Json& charts) {
  const evaluation::Comparison& comparison = *run.evaluation.comparison;
  add_absolute(comparison, charts);
  add_relative(comparison, charts);
  add_covariance_chart(run, charts);
  add_share(comparison, charts);
  if (comparison.kitti) add_kitti(*comparison.kitti, charts);
  add_association(run, charts);
}

void add_health_charts(const RunData& run, Json& charts) {
  const pipeline::FrameTable& frames = run.frames;
  add_columns(frames, {"residual", "health", "Residual rms", "m"}, {{"residual", "residual_rms_m"}},
              true, 1, charts);
  add_columns(frames, {"inliers", "health", "Inliers", "%"}, {{"inliers", "inlier_share"}}, true,
              100, charts);
  add_columns(frames, {"matches", "health", "Matches", ""},
              {{"lines", "line_matches"}, {"planes", "plane_matches"}}, true, 1, charts);
  Chart eigenvalues("eigenvalues", "health", "Eigenvalues of the information per match", "");
  eigenvalues.flag("log");
  add_columns(frames, eigenvalues,
              {{"1", "eigenvalue_1"},
               {"2", "eigenvalue_2"},
               {"3", "eigenvalue_3"},
               {"4", "eigenvalue_4"},
               {"5", "eigenvalue_5"},
               {"6", "eigenvalue_6"}},
              true, 1, charts);
  add_columns(frames, {"degenerate", "health", "Degenerate directions", ""},
              {{"directions", "degenerate_directions"}}, true, 1, charts);
  add_columns(frames, {"speed", "health", "Speed", "m/s"}, {{"speed", "speed_mps"}}, false, 1,
              charts);
}

void add_timing_charts(const RunData& run, Json& charts) {
  const pipeline::FrameTable& frames = run.frames;
  Chart chart("timing", "timing", "Time of each stage, one on top of the other", "ms");
  chart.flag("stacked");
  for (const std::string& column : frames.columns()) {
    if (!column.ends_with("_ms") || column == "total_ms") continue;
    const std::string stage = column.substr(0, column.size() - 3);
    // The search for the initial speed is charged to the first frame and would flatten the rest.
    if (stage != "start") chart.series(stage, frames.column(column));
  }
  charts.push_back(chart.take());
}

void add_poses(const RunData& run, Model& model) {
  model.json["poses"] = {{"frame", numbers(run.frames.column("frame"))},
                         {"time_s", numbers(seconds_from_start(run))},
                         {"distance_m", numbers(run.estimate.accumulated_distances())}};
}

}  // namespace traverse::report
