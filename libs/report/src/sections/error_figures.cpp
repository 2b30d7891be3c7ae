#include "sections/error_figures.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "traverse/evaluation/titles.hpp"
#include "traverse/render/pictures/distribution.hpp"
#include "traverse/render/pictures/kitti_drift.hpp"
#include "traverse/render/pictures/map_from_above.hpp"
#include "traverse/render/pictures/time_series.hpp"
#include "traverse/render/pictures/trajectory_coloured.hpp"
#include "traverse/render/pictures/violins.hpp"

#include "charts/series.hpp"
#include "run/number_texts.hpp"

namespace traverse::report {

using evaluation::Relation;
using render::Style;

std::string ape_statistic(const evaluation::Comparison& comparison) {
  const auto* ape = find_ape(comparison, Relation::kTranslation);
  if (ape == nullptr) return {};
  return fmt::format("APE rmse {} m, {}, {} pairs", short_number(ape->statistics.rmse),
                     evaluation::describe(comparison.alignment, ape->statistics.count),
                     ape->statistics.count);
}

namespace {

void add_coloured_trajectory(const RunData& run, FigureMaker& maker) {
  const auto& comparison = *run.evaluation.comparison;
  const auto* ape = find_ape(comparison, Relation::kTranslation);
  if (ape == nullptr) return;
  const geometry::Trajectory estimate = aligned_estimate(run);
  const std::vector<double> values = for_each_pose(run, ape->values);
  maker.add(
      "trajectory", "trajectory-error",
      "The same trajectory, coloured by the distance of each pose from its match on the reference.",
      [&](const Style& style) {
        return render::trajectory_coloured(
            estimate, {values, "APE, translation", "m", render::ColourMap::kViridis},
            run.reference ? &*run.reference : nullptr,
            maker.caption("Trajectory coloured by error", ape_statistic(comparison)), style);
      },
      "3d");
}

void add_error_over_time(const RunData& run, FigureMaker& maker) {
  const auto& comparison = *run.evaluation.comparison;
  const std::vector<double> times = match_times(run);
  const auto* position = find_ape(comparison, Relation::kTranslation);
  const auto* angle = find_ape(comparison, Relation::kAngleDeg);
  if (position == nullptr) return;
  render::TimeSeries series;
  series.panels.push_back(
      {"APE, position",
       "m",
       {{"", times, position->values}},
       render::Level{position->statistics.rmse,
                     fmt::format("rmse {} m", short_number(position->statistics.rmse))}});
  if (angle != nullptr) {  // not so where a rotation of the alignment is not determined
    series.panels.push_back(
        {"APE, angle",
         "deg",
         {{"", times, angle->values}},
         render::Level{angle->statistics.rmse,
                       fmt::format("rmse {} deg", short_number(angle->statistics.rmse))}});
  }
  std::vector<double> pair_times;
  const auto* rpe = find_rpe(comparison, Relation::kTranslation, 10);
  if (rpe != nullptr) {
    for (const auto& pair : rpe->pairs) pair_times.push_back(times[pair.to]);
    series.panels.push_back(
        {"RPE, 10 frames",
         "m",
         {{"", pair_times, rpe->values}},
         render::Level{rpe->statistics.rmse,
                       fmt::format("rmse {} m", short_number(rpe->statistics.rmse))}});
  }
  maker.add(
      "error", "error-over-time",
      "Error over time. The absolute error carries every earlier mistake; the relative one "
      "shows where mistakes are made.",
      [&](const Style& style) {
        return render::time_series(
            series, maker.caption("Error over time", ape_statistic(comparison)), style);
      },
      "charts");
  maker.add("error", "error-distribution",
            "How the absolute errors are spread: share of the poses up to each error.",
            [&](const Style& style) {
              return render::distribution(
                  {position->values, "APE, translation", "m"},
                  maker.caption("Distribution of the absolute error", ape_statistic(comparison)),
                  style);
            });
}

/// Box and violin of the absolute error and of the relative errors over each number of frames.
void add_spreads(const evaluation::Comparison& comparison, FigureMaker& maker) {
  std::vector<render::Sampled> distributions;
  if (const auto* ape = find_ape(comparison, Relation::kTranslation)) {
    distributions.push_back({ape->values, "APE, position", "m"});
  }
  for (const auto& rpe : comparison.rpe) {
    if (rpe.relation != Relation::kTranslation) continue;
    distributions.push_back(
        {rpe.values, fmt::format("RPE over {}", to_text(rpe.options.delta)), "m"});
  }
  maker.add("error", "error-violins",
            "How absolute and relative errors are spread: density, quartiles and median, whiskers "
            "from 5 to 95 %.",
            [&](const Style& style) {
              return render::violins(
                  distributions,
                  maker.caption("Distributions of the errors", ape_statistic(comparison)), style);
            });
}

/// The way coloured by the drift of the KITTI segments that each pose lies in.
void add_kitti_segments(const RunData& run, const evaluation::KittiDrift& kitti,
                        FigureMaker& maker) {
  const auto& matches = run.evaluation.comparison->association.matches;
  std::vector<double> sums(matches.size(), 0);
  std::vector<double> counts(matches.size(), 0);
  for (const auto& segment : kitti.segments) {
    for (std::size_t k = segment.first; k <= segment.last; ++k) {
      sums[k] += segment.translation_percent;
      ++counts[k];
    }
  }
  // Nothing over nothing is NaN: no segment covers the pose.
  for (std::size_t k = 0; k < sums.size(); ++k) sums[k] /= counts[k];
  const std::vector<double> values = for_each_pose(run, sums);
  const geometry::Trajectory estimate = aligned_estimate(run);
  maker.add(
      "kitti", "kitti-segments",
      "The trajectory, coloured by the mean translational drift of the segments through each pose.",
      [&](const Style& style) {
        return render::trajectory_coloured(
            estimate, {values, "drift of the segments here", "%", render::ColourMap::kViridis},
            run.reference ? &*run.reference : nullptr,
            maker.caption("KITTI drift along the trajectory",
                          plural(kitti.segments.size(), "segment") + " of 100 to 800 m"),
            style);
      });
}

void add_kitti_drift(const evaluation::KittiDrift& kitti, FigureMaker& maker) {
  if (kitti.by_length.size() < 2) return;  // a single point says no more than the table
  std::vector<render::DriftAtLength> points;
  for (const auto& bin : kitti.by_length) {
    points.push_back(
        {bin.centre, bin.translation_percent, 100 * bin.rotation_deg_per_m, bin.segments});
  }
  maker.add(
      "kitti", "kitti-drift", "Drift over segments of each length, as KITTI measures it.",
      [&](const Style& style) {
        return render::kitti_drift(
            points,
            maker.caption("KITTI drift", fmt::format("{} %, {} deg/100 m, {} segments, {} frame",
                                                     short_number(kitti.translation_percent),
                                                     short_number(100 * kitti.rotation_deg_per_m),
                                                     kitti.segments.size(), kitti.frame)),
            style);
      });
}

void add_association(const RunData& run, FigureMaker& maker) {
  const auto& comparison = *run.evaluation.comparison;
  const std::vector<double> times = match_times(run);
  std::vector<double> differences_ms;
  for (const auto& match : comparison.association.matches) {
    differences_ms.push_back(1000 * match.time_difference_s);
  }
  render::TimeSeries series;
  series.panels.push_back({"estimate − reference", "ms", {{"", times, differences_ms}}, {}});
  maker.add(
      "association", "association",
      "Association: the time from each pose to its match on the reference; a gap is a "
      "stretch without partners.",
      [&](const Style& style) {
        return render::time_series(
            series,
            maker.caption(
                "Association in time",
                fmt::format("{} of {} poses matched, {} of the reference", differences_ms.size(),
                            run.estimate.size(), comparison.reference.poses)),
            style);
      },
      "charts");
}

}  // namespace

void add_error_figures(const RunData& run, FigureMaker& maker) {
  const auto& comparison = *run.evaluation.comparison;
  add_coloured_trajectory(run, maker);
  add_error_over_time(run, maker);
  add_association(run, maker);
  add_spreads(comparison, maker);
  if (comparison.kitti) {
    add_kitti_drift(*comparison.kitti, maker);
    add_kitti_segments(run, *comparison.kitti, maker);
  }
}

}  // namespace traverse::report
