#include "traverse/batch/metric.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "traverse/evaluation/bootstrap.hpp"
#include "traverse/evaluation/checkpoints.hpp"
#include "traverse/evaluation/relation.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/pipeline/frame_table.hpp"
#include "traverse/pipeline/run_folder.hpp"

namespace traverse::batch {

namespace {

using nlohmann::json;
using Values = std::map<std::string, double, std::less<>>;

constexpr std::array<const char*, 6> kStatistics{"rmse", "mean", "median", "std", "min", "max"};
/// The stretches of evaluation::run_evaluation_options(), as their keys name them.
constexpr std::array<const char*, 5> kStretches{"1f", "10f", "50f", "100f", "100m"};

std::string key_of(std::string_view relation) {
  std::string key(relation);
  std::replace(key.begin(), key.end(), '-', '_');
  return key;
}

std::string stretch_title(std::string_view stretch) {
  const std::string number(stretch.substr(0, stretch.size() - 1));
  if (stretch.back() == 'm') return number + " m";
  return number + (number == "1" ? " frame" : " frames");
}

/// "", " angle", " full transformation": translation and the mean square need no word.
std::string qualifier(evaluation::Relation relation, std::string_view statistic) {
  std::string text;
  if (relation == evaluation::Relation::kAngleDeg) {
    text = " angle";
  } else if (relation != evaluation::Relation::kTranslation) {
    text = " " + std::string(evaluation::title_of(relation));
  }
  if (statistic != "rmse") text += " " + std::string(statistic);
  return text;
}

/// Drift by the length of the stretch.
void take_lengths(const json& evaluation, Values& values) {
  const json::json_pointer kitti("/kitti/by_length");
  if (evaluation.contains(kitti)) {
    for (const json& bin : evaluation.at(kitti)) {
      values[kitti_length_key(static_cast<int>(bin.at("length_m").get<double>()))] =
          bin.at("translation_percent").get<double>();
    }
  }
  const json::json_pointer lengths("/sub_trajectories/lengths");
  if (!evaluation.contains(lengths)) return;
  const double path_m = evaluation.at("reference").at("path_m").get<double>();
  for (const json& errors : evaluation.at(lengths)) {
    const double share = errors.at("length_m").get<double>() / path_m;
    values[path_share_key(10 * static_cast<int>(std::lround(10 * share)))] =
        errors.at("translation_percent").at("mean").get<double>();
  }
}

std::vector<Metric> make_metrics() {
  std::vector<Metric> metrics;
  for (const auto& [name, relation] : evaluation::kRelationNames) {
    if (!evaluation::is_absolute(relation)) continue;
    for (const char* statistic : kStatistics) {
      metrics.push_back({fmt::format("ape_{}_{}", key_of(name), statistic),
                         "APE" + qualifier(relation, statistic),
                         std::string(evaluation::unit_of(relation))});
    }
  }
  for (const char* stretch : kStretches) {
    for (const auto& [name, relation] : evaluation::kRelationNames) {
      for (const char* statistic : kStatistics) {
        metrics.push_back({fmt::format("rpe_{}_{}_{}", stretch, key_of(name), statistic),
                           "RPE " + stretch_title(stretch) + qualifier(relation, statistic),
                           std::string(evaluation::unit_of(relation))});
      }
    }
  }
  for (const int length_m : kKittiLengths_m) {
    metrics.push_back(
        {kitti_length_key(length_m), fmt::format("Drift over {} m (KITTI)", length_m), "%"});
  }
  for (const int share : kPathShares_percent) {
    metrics.push_back(
        {path_share_key(share), fmt::format("Drift over {} % of the path (rpg)", share), "%"});
  }
  const std::vector<Metric> others{
      {"kitti_translation_percent", "Drift (KITTI)", "%"},
      {"kitti_rotation_deg_per_m", "Rotation drift (KITTI)", "deg/m"},
      {"kitti_segments", "KITTI segments", "", false},
      {"end_error_m", "Closing error", "m"},
      {"end_error_percent", "Closing error", "%"},
      {"end_rotation_deg", "End rotation", "deg"},
      {"path_estimate_m", "Path, estimate", "m", false},
      {"path_reference_m", "Path, reference", "m", false},
      {"pairs", "Pairs", "", false},
      {"checkpoint_horizontal_rmse_m", "Checkpoints, horizontal", "m"},
      {"checkpoint_vertical_rmse_m", "Checkpoints, vertical", "m"},
      {"checkpoint_horizontal_p95_m", "Checkpoints, horizontal, 95 %", "m"},
      {"checkpoint_vertical_p95_m", "Checkpoints, vertical, 95 %", "m"},
      {"checkpoints", "Checkpoints", "", false},
      {"mme", "Map entropy", "nats"},
      {"mme_queries", "Map entropy, queries", "", false},
      {"mpv_m", "Plane deviation", "m"},
      {"odometry_ape_translation_rmse", "APE before loops", "m"},
      {"odometry_mme", "Map entropy before loops", "nats"},
      {"loop_candidates", "Loop candidates", "", false},
      {"loops_accepted", "Loops closed", "", false},
      {"jump_p95_m", "Jump at fixes, 95 %", "m"},
      {"jump_max_m", "Largest jump", "m"},
      {"jumps", "Jumps", ""},
      {"roughness_m", "Roughness", "m"},
      {"registered_share", "Registered", "", false, false, true},
      {"restarts", "Restarts", ""},
      {"frames_used", "Frames used", "", false},
      {"frames_skipped", "Records skipped", ""},
      {"degenerate_frames", "Degenerate frames", ""},
      {"map_points", "Map points", "", false},
      {"frame_median_ms", "Time per frame", "ms", true, true},
      {"frame_p95_ms", "Time per frame, 95 %", "ms", true, true},
      {"frame_max_ms", "Time per frame, most", "ms", true, true},
      {"frames_total_ms", "Time of all frames", "ms", true, true},
      {"wall_s", "Wall time", "s", true, true},
      {"cpu_s", "CPU time", "s", true, true},
      {"peak_memory_mb", "Memory", "MB", true, true}};
  metrics.insert(metrics.end(), others.begin(), others.end());
  return metrics;
}

/// The file without the values behind each figure, which are most of it; null if it is no JSON.
json read_figures(const std::filesystem::path& file) {
  std::ifstream stream(file);
  const auto keep = [](int, json::parse_event_t event, json& parsed) {
    return event != json::parse_event_t::key || (parsed != "per_pair" && parsed != "per_segment");
  };
  json figures = json::parse(stream, keep, /*allow_exceptions=*/false);
  return figures.is_object() ? figures : json(nullptr);
}

/// The number at `path`, if there is one.
void take(const json& figures, const char* path, const std::string& key, Values& values) {
  const json::json_pointer pointer(path);
  if (!figures.contains(pointer) || !figures.at(pointer).is_number()) return;
  values[key] = figures.at(pointer).get<double>();
}

void take_statistics(const json& statistics, const std::string& prefix, Values& values) {
  for (const char* statistic : kStatistics) {
    take(statistics, fmt::format("/{}", statistic).c_str(), prefix + "_" + statistic, values);
  }
}

void take_accuracy(const json& evaluation, Values& values) {
  if (evaluation.contains("ape")) {
    for (const auto& [relation, statistics] : evaluation["ape"].items()) {
      take_statistics(statistics, "ape_" + key_of(relation), values);
    }
  }
  if (evaluation.contains("rpe")) {
    for (const json& rpe : evaluation["rpe"]) {
      take_statistics(rpe.at("stats"),
                      fmt::format("rpe_{}{}_{}", rpe.at("delta").get<double>(),
                                  rpe.at("unit").get<std::string>(),
                                  key_of(rpe.at("relation").get<std::string>())),
                      values);
    }
  }
  take(evaluation, "/kitti/translation_percent", "kitti_translation_percent", values);
  take(evaluation, "/kitti/rotation_deg_per_m", "kitti_rotation_deg_per_m", values);
  take(evaluation, "/kitti/segments", "kitti_segments", values);
  take_lengths(evaluation, values);
  take(evaluation, "/path/end_error_m", "end_error_m", values);
  take(evaluation, "/path/end_error_percent", "end_error_percent", values);
  take(evaluation, "/path/end_rotation_deg", "end_rotation_deg", values);
  take(evaluation, "/path/estimate_m", "path_estimate_m", values);
  take(evaluation, "/path/reference_m", "path_reference_m", values);
  take(evaluation, "/association/pairs", "pairs", values);
  take(evaluation, "/consistency/mme", "mme", values);
  take(evaluation, "/consistency/queries", "mme_queries", values);
  take(evaluation, "/consistency/mpv_m", "mpv_m", values);
}

void take_run(const json& run, Values& values) {
  take(run, "/frames/used", "frames_used", values);
  take(run, "/health/registered_share", "registered_share", values);
  take(run, "/health/restarts", "restarts", values);
  take(run, "/map/points", "map_points", values);
  for (const char* name : {"frame_median", "frame_p95", "frame_max"}) {
    take(run, fmt::format("/timing_ms/{}", name).c_str(), fmt::format("{}_ms", name), values);
  }
  take(run, "/timing_ms/total", "frames_total_ms", values);
  if (run.contains("/frames/skipped"_json_pointer)) {
    double skipped = 0;
    for (const json& count : run["frames"]["skipped"]) skipped += count.get<double>();
    values["frames_skipped"] = skipped;
  }
}

/// Residuals at surveyed points: of those that check, or of all where all align.
void take_checkpoints(const json& residuals, Values& values) {
  const char* kind = residuals.contains("/check/count"_json_pointer) ? "check" : "control";
  for (const auto& [from, to] : {std::pair{"rmse_horizontal_m", "checkpoint_horizontal_rmse_m"},
                                 std::pair{"rmse_vertical_m", "checkpoint_vertical_rmse_m"},
                                 std::pair{"p95_horizontal_m", "checkpoint_horizontal_p95_m"},
                                 std::pair{"p95_vertical_m", "checkpoint_vertical_p95_m"},
                                 std::pair{"count", "checkpoints"}}) {
    take(residuals, fmt::format("/{}/{}", kind, from).c_str(), to, values);
  }
}

/// Of a run that closed loops: its odometry, and what became of the candidates.
void take_loops(const pipeline::RunFolder& folder, Values& values) {
  const json odometry = read_figures(folder.odometry_evaluation());
  take(odometry, "/ape/translation/rmse", "odometry_ape_translation_rmse", values);
  take(odometry, "/consistency/mme", "odometry_mme", values);
  std::ifstream stream(folder.loops());
  std::string line;
  if (!std::getline(stream, line)) return;
  const auto heads = files::split_cells(line, ',');
  const auto verdict = std::find(heads.begin(), heads.end(), "verdict");
  if (verdict == heads.end()) return;
  const auto column = static_cast<std::size_t>(verdict - heads.begin());
  double candidates = 0;
  double accepted = 0;
  while (std::getline(stream, line)) {
    const auto cells = files::split_cells(line, ',');
    ++candidates;
    if (column < cells.size() && cells[column] == "accepted") ++accepted;
  }
  values["loop_candidates"] = candidates;
  values["loops_accepted"] = accepted;
}

/// Of an estimator that tells which directions its scans determine.
void take_degenerate(const pipeline::FrameTable& frames, Values& values) {
  if (!frames.has("degenerate_directions")) return;
  const std::vector<double> directions = frames.column("degenerate_directions");
  values["degenerate_frames"] = static_cast<double>(
      std::count_if(directions.begin(), directions.end(), [](double count) { return count > 0; }));
}

/// Of navigation: how smooth the path is at the fixes, as the report has it.
void take_jumps(const pipeline::FrameTable& frames, Values& values) {
  constexpr double kJump_m = 0.05;
  const std::vector<double> by_gnss = frames.column("by_gnss");
  const auto told_at_fixes = [&](const char* column) {
    std::vector<double> told;
    const std::vector<double> all = frames.column(column);
    for (std::size_t i = 0; i < std::min(all.size(), by_gnss.size()); ++i) {
      if (by_gnss[i] != 0 && all[i] >= 0) told.push_back(all[i]);
    }
    return told;
  };
  const std::vector<double> jumps = told_at_fixes("correction_m");
  if (!jumps.empty()) {
    values["jump_p95_m"] = evaluation::figure_of(jumps, evaluation::Figure::kP95);
    values["jump_max_m"] = *std::max_element(jumps.begin(), jumps.end());
    values["jumps"] = static_cast<double>(
        std::count_if(jumps.begin(), jumps.end(), [](double jump) { return jump > kJump_m; }));
  }
  const std::vector<double> roughness = told_at_fixes("roughness_m");
  if (!roughness.empty()) {
    values["roughness_m"] = evaluation::figure_of(roughness, evaluation::Figure::kRmse);
  }
}

}  // namespace

std::string kitti_length_key(int length_m) {
  return fmt::format("kitti_{}m_translation_percent", length_m);
}

std::string path_share_key(int share_percent) {
  return fmt::format("rpg_{}_translation_percent_mean", share_percent);
}

const std::vector<Metric>& known_metrics() {
  static const std::vector<Metric> kMetrics = make_metrics();
  return kMetrics;
}

const Metric* find_metric(std::string_view key) {
  const auto& metrics = known_metrics();
  const auto found = std::find_if(metrics.begin(), metrics.end(),
                                  [&](const Metric& metric) { return metric.key == key; });
  return found == metrics.end() ? nullptr : &*found;
}

std::string with_unit(const Metric& metric) {
  return metric.unit.empty() ? metric.title : fmt::format("{} [{}]", metric.title, metric.unit);
}

std::vector<std::string> default_metrics() {
  return {"ape_translation_rmse",      "ape_angle_deg_rmse",
          "rpe_10f_translation_rmse",  "rpe_10f_angle_deg_rmse",
          "kitti_translation_percent", "kitti_rotation_deg_per_m",
          "end_error_percent",         "mme",
          "frame_median_ms",           "peak_memory_mb"};
}

std::vector<std::pair<std::string, double>> read_metrics(const std::filesystem::path& run_folder) {
  Values values;
  const pipeline::RunFolder folder{run_folder};
  try {
    take_accuracy(read_figures(folder.evaluation()), values);
    take_run(read_figures(folder.record()), values);
    take_checkpoints(read_figures(folder.path / evaluation::kCheckpointsFile), values);
    take_loops(folder, values);
    if (std::filesystem::is_regular_file(folder.frames())) {
      const auto frames = pipeline::FrameTable::read_csv(folder.frames());
      take_degenerate(frames, values);
      take_jumps(frames, values);
    }
  } catch (const json::exception&) {
    values.clear();  // not files of this program: a run that crashed while it wrote
  } catch (const files::InputError&) {
    values.clear();
  }
  std::vector<std::pair<std::string, double>> ordered;
  for (const Metric& metric : known_metrics()) {
    const auto found = values.find(metric.key);
    if (found != values.end()) ordered.emplace_back(metric.key, found->second);
  }
  return ordered;
}

}  // namespace traverse::batch
