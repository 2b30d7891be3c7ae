#include "charts/paired_series.hpp"

#include <cmath>

#include "charts/navigation_series.hpp"
#include "charts/series.hpp"

namespace traverse::report {

namespace {

using evaluation::Comparison;
using evaluation::Relation;

Series of_ape(const Comparison& comparison, Relation relation) {
  Series series;
  const auto* ape = find_ape(comparison, relation);
  if (ape == nullptr || comparison.stamps.empty()) return series;
  for (std::size_t k = 0; k < ape->values.size(); ++k) {
    series[comparison.stamps[k].nanoseconds] = ape->values[k];
  }
  return series;
}

Series of_rpe(const Comparison& comparison) {
  Series series;
  const auto* rpe = find_rpe(comparison, Relation::kTranslation, 10);
  if (rpe == nullptr || comparison.stamps.empty()) return series;
  for (std::size_t k = 0; k < rpe->values.size(); ++k) {
    series[comparison.stamps[rpe->pairs[k].to].nanoseconds] = rpe->values[k];
  }
  return series;
}

Series of_kitti(const Comparison& comparison, bool rotation) {
  Series series;
  if (!comparison.kitti || comparison.stamps.empty()) return series;
  for (const auto& segment : comparison.kitti->segments) {
    // Lengths are multiples of 100 m: added as nanoseconds they keep segments of one start apart.
    const std::int64_t key =
        comparison.stamps[segment.first].nanoseconds + static_cast<std::int64_t>(segment.length_m);
    series[key] = rotation ? 100 * segment.rotation_deg_per_m : segment.translation_percent;
  }
  return series;
}

Series of_frames(const pipeline::FrameTable& frames) {
  Series series;
  const std::vector<double> number = frames.column("frame");
  const std::vector<double> total = frames.column("total_ms");
  for (std::size_t i = 0; i < total.size(); ++i) series[std::llround(number[i])] = total[i];
  return series;
}

/// By the stamps of the fixes, which runs of one recording share.
Series of_fixes(const pipeline::FrameTable& frames, const std::string& column) {
  Series series;
  const std::vector<double> stamp = frames.column("stamp_s");
  const std::vector<double> values = at_fixes(frames, column);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) series[std::llround(1e6 * stamp[i])] = values[i];
  }
  return series;
}

}  // namespace

const std::vector<SeriesFigure>& series_figures() {
  static const std::vector<SeriesFigure> figures{
      {"ape_rmse_m", evaluation::Figure::kRmse},
      {"ape_angle_rmse_deg", evaluation::Figure::kRmse},
      {"kitti_translation_percent", evaluation::Figure::kMean},
      {"kitti_rotation_deg_per_100m", evaluation::Figure::kMean},
      {"rpe_10_frames_rmse_m", evaluation::Figure::kRmse},
      {"jump_p95_m", evaluation::Figure::kP95},
      {"roughness_m", evaluation::Figure::kRmse},
      {"frame_median_ms", evaluation::Figure::kMedian}};
  return figures;
}

Series series_of(const RunData& run, const std::string& id) {
  if (id == "frame_median_ms") return of_frames(run.frames);
  if (id == "jump_p95_m") return of_fixes(run.frames, "correction_m");
  if (id == "roughness_m") return of_fixes(run.frames, "roughness_m");
  if (!run.evaluation.comparison) return {};
  const Comparison& comparison = *run.evaluation.comparison;
  if (id == "ape_rmse_m") return of_ape(comparison, Relation::kTranslation);
  if (id == "ape_angle_rmse_deg") return of_ape(comparison, Relation::kAngleDeg);
  if (id == "rpe_10_frames_rmse_m") return of_rpe(comparison);
  if (id == "kitti_translation_percent") return of_kitti(comparison, false);
  if (id == "kitti_rotation_deg_per_100m") return of_kitti(comparison, true);
  return {};
}

CommonValues common_values(const Series& first, const Series& second) {
  CommonValues common;
  for (const auto& [moment, value] : first) {
    const auto found = second.find(moment);
    if (found == second.end()) continue;
    common.first.push_back(value);
    common.second.push_back(found->second);
  }
  return common;
}

}  // namespace traverse::report
