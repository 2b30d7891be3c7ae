#include "figures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "traverse/evaluation/titles.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/pipeline/run_folder.hpp"
#include "traverse/render/pictures/distribution.hpp"
#include "traverse/render/pictures/kitti_drift.hpp"
#include "traverse/render/pictures/map_from_above.hpp"
#include "traverse/render/pictures/scan_features.hpp"
#include "traverse/render/pictures/stage_times.hpp"
#include "traverse/render/pictures/time_series.hpp"
#include "traverse/render/pictures/trajectory_coloured.hpp"
#include "traverse/render/pictures/trajectory_from_above.hpp"
#include "traverse/render/pictures/trajectory_from_the_side.hpp"
#include "traverse/render/renderer.hpp"

#include "number_text.hpp"

namespace traverse::report {

namespace {

using evaluation::Relation;
using render::Caption;
using render::Drawing;
using render::Style;

/// Draws one picture after another with one renderer.
class FigureMaker {
 public:
  FigureMaker(const RunData& run, const std::function<void(const std::string&)>& picture_drawn)
      : run_(run),
        picture_drawn_(picture_drawn),
        images_(pipeline::RunFolder{run.folder}.images()) {
    files::make_writable_folder(images_);
    style_dark_.theme = render::dark_theme();
  }

  Caption caption(std::string title, std::string statistic) const {
    return {std::move(title), std::move(statistic), run_.recording_name(), run_.pipeline_name(),
            run_.date()};
  }

  /// `draw` makes the drawing for a style; `text` stands below the picture on the page.
  template <typename Draw>
  void add(const std::string& section, const std::string& name, const std::string& text,
           const Draw& draw) {
    Figure figure{name, section, text, {}, {}};
    figure.light_png = finished(draw(style_light_), name + ".png");
    figure.dark_png = finished(draw(style_dark_), name + "_dark.png");
    figures_.push_back(std::move(figure));
    picture_drawn_(name);
  }

  std::vector<Figure> take() { return std::move(figures_); }

 private:
  std::string finished(const Drawing& drawing, const std::string& file) {
    std::string png = renderer_.render(drawing).encode_png();
    files::write_text(images_ / file, png);
    return png;
  }

  const RunData& run_;
  const std::function<void(const std::string&)>& picture_drawn_;
  std::filesystem::path images_;
  render::Renderer renderer_;
  Style style_light_;
  Style style_dark_;
  std::vector<Figure> figures_;
};

const evaluation::Ape* find_ape(const evaluation::Comparison& comparison, Relation relation) {
  const auto found = std::find_if(comparison.ape.begin(), comparison.ape.end(),
                                  [&](const auto& ape) { return ape.relation == relation; });
  return found == comparison.ape.end() ? nullptr : &*found;
}

/// The shortest stretch over which relative errors were taken, in frames.
const evaluation::Rpe* find_rpe(const evaluation::Comparison& comparison, double frames) {
  for (const auto& rpe : comparison.rpe) {
    if (rpe.relation == Relation::kTranslation &&
        rpe.options.delta.unit == evaluation::DeltaUnit::kFrames &&
        rpe.options.delta.value == frames) {
      return &rpe;
    }
  }
  return nullptr;
}

std::vector<double> seconds_from_start(const RunData& run) {
  std::vector<double> seconds;
  for (const auto stamp : run.estimate.stamps()) {
    seconds.push_back(geometry::seconds_between(run.estimate.stamps().front(), stamp));
  }
  return seconds;
}

/// The estimate brought onto the reference as the evaluation did, to be drawn over it.
geometry::Trajectory aligned_estimate(const RunData& run) {
  if (!run.evaluation.comparison) return run.estimate;
  std::vector<geometry::Pose3> poses =
      evaluation::aligned(run.estimate.poses(), run.evaluation.comparison->alignment);
  return geometry::Trajectory::stamped(run.estimate.stamps(), std::move(poses));
}

std::string ape_statistic(const evaluation::Comparison& comparison) {
  const auto* ape = find_ape(comparison, Relation::kTranslation);
  if (ape == nullptr) return {};
  return fmt::format("APE rmse {} m, {}, {} pairs", short_number(ape->statistics.rmse),
                     evaluation::describe(comparison.alignment, ape->statistics.count),
                     ape->statistics.count);
}

std::string path_statistic(const RunData& run) {
  return run.evaluation.comparison
             ? ape_statistic(*run.evaluation.comparison)
             : fmt::format("{} m in {} poses, no reference",
                           short_number(run.estimate.path_length()), run.estimate.size());
}

void add_trajectories(const RunData& run, FigureMaker& maker) {
  const geometry::Trajectory estimate = aligned_estimate(run);
  const std::vector<render::NamedTrajectory> named{{"estimate", &estimate}};
  // A reference that could not be matched is in another place: it would only shrink the picture.
  const geometry::Trajectory* reference =
      run.reference && run.evaluation.comparison ? &*run.reference : nullptr;
  const std::string against =
      reference != nullptr ? " against the reference (dashed), after alignment" : "";
  maker.add("trajectory", "trajectory-above", "The way from above" + against + ".",
            [&](const Style& style) {
              return render::trajectory_from_above(
                  named, reference, maker.caption("Trajectory from above", path_statistic(run)),
                  style);
            });
  maker.add("trajectory", "trajectory-side", "Height over the distance travelled" + against + ".",
            [&](const Style& style) {
              return render::trajectory_from_the_side(
                  named, reference, maker.caption("Trajectory from the side", path_statistic(run)),
                  style);
            });
}

/// One value a pose of the estimate; NaN where it found no partner.
std::vector<double> for_each_pose(const RunData& run, const std::vector<double>& for_each_match) {
  std::vector<double> values(run.estimate.size(), std::numeric_limits<double>::quiet_NaN());
  const auto& matches = run.evaluation.comparison->association.matches;
  for (std::size_t k = 0; k < matches.size(); ++k) values[matches[k].estimate] = for_each_match[k];
  return values;
}

void add_coloured_trajectory(const RunData& run, FigureMaker& maker) {
  const auto& comparison = *run.evaluation.comparison;
  const auto* ape = find_ape(comparison, Relation::kTranslation);
  if (ape == nullptr) return;
  const geometry::Trajectory estimate = aligned_estimate(run);
  const std::vector<double> values = for_each_pose(run, ape->values);
  maker.add(
      "trajectory", "trajectory-error",
      "The same way, coloured by the distance of each pose from its partner on the reference.",
      [&](const Style& style) {
        return render::trajectory_coloured(
            estimate, {values, "APE, translation", "m", render::ColourMap::kViridis},
            run.reference ? &*run.reference : nullptr,
            maker.caption("Trajectory coloured by error", ape_statistic(comparison)), style);
      });
}

std::vector<double> match_times(const RunData& run) {
  const auto& stamps = run.evaluation.comparison->stamps;
  std::vector<double> seconds;
  for (const auto stamp : stamps) {
    seconds.push_back(geometry::seconds_between(run.estimate.stamps().front(), stamp));
  }
  return seconds;
}

void add_error_over_time(const RunData& run, FigureMaker& maker) {
  const auto& comparison = *run.evaluation.comparison;
  const std::vector<double> times = match_times(run);
  const auto* position = find_ape(comparison, Relation::kTranslation);
  const auto* angle = find_ape(comparison, Relation::kAngleDeg);
  if (position == nullptr || angle == nullptr) return;
  render::TimeSeries series;
  series.panels.push_back(
      {"APE, position",
       "m",
       {{"", times, position->values}},
       render::Level{position->statistics.rmse,
                     fmt::format("rmse {} m", short_number(position->statistics.rmse))}});
  series.panels.push_back(
      {"APE, angle",
       "deg",
       {{"", times, angle->values}},
       render::Level{angle->statistics.rmse,
                     fmt::format("rmse {} deg", short_number(angle->statistics.rmse))}});
  std::vector<double> pair_times;
  const auto* rpe = find_rpe(comparison, 10);
  if (rpe != nullptr) {
    for (const auto& pair : rpe->pairs) pair_times.push_back(times[pair.to]);
    series.panels.push_back(
        {"RPE, 10 frames",
         "m",
         {{"", pair_times, rpe->values}},
         render::Level{rpe->statistics.rmse,
                       fmt::format("rmse {} m", short_number(rpe->statistics.rmse))}});
  }
  maker.add("error", "error-over-time",
            "Error over time. The absolute error carries every earlier mistake; the relative one "
            "shows where mistakes are made.",
            [&](const Style& style) {
              return render::time_series(
                  series, maker.caption("Error over time", ape_statistic(comparison)), style);
            });
  maker.add("error", "error-distribution",
            "How the absolute errors are spread: share of the poses up to each error.",
            [&](const Style& style) {
              return render::distribution(
                  {position->values, "APE, translation", "m"},
                  maker.caption("Distribution of the absolute error", ape_statistic(comparison)),
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
      "error", "kitti-drift", "Drift over segments of each length, as KITTI measures it.",
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

std::vector<float> floats(const dataset::PointCloud& cloud, std::string_view field) {
  const dataset::FieldValues* values = cloud.find(field);
  return values == nullptr ? std::vector<float>() : dataset::to_floats(*values);
}

std::string map_statistic(const RunData& run) {
  const std::string points =
      fmt::format("{} points, one a {} m voxel", count_text(run.map.size()),
                  short_number(run.record.at("map").at("voxel_m").get<double>()));
  const auto& score = run.evaluation.consistency;
  return score ? fmt::format("{}; map entropy {}", points, short_number(score->mme)) : points;
}

void add_maps(const RunData& run, FigureMaker& maker) {
  const std::vector<float> x = floats(run.map, "x");
  const std::vector<float> y = floats(run.map, "y");
  const std::vector<float> z = floats(run.map, "z");
  const std::vector<float> intensity = floats(run.map, "intensity");
  const render::MapPoints points{x, y, z, Eigen::Vector3d::Zero()};
  maker.add("map", "map-height", "The map from above, coloured by height, with the way in it.",
            [&](const Style& style) {
              return render::map_from_above(points, {}, &run.estimate,
                                            maker.caption("Map by height", map_statistic(run)),
                                            style);
            });
  const auto [least, most] = std::minmax_element(intensity.begin(), intensity.end());
  if (intensity.empty() || *least == *most) return;
  const render::PointValues by_intensity{intensity, "intensity", "", render::ColourMap::kCividis};
  maker.add("map", "map-intensity", "The same map, coloured by the strength of the returns.",
            [&](const Style& style) {
              return render::map_from_above(points, by_intensity, &run.estimate,
                                            maker.caption("Map by intensity", map_statistic(run)),
                                            style);
            });
}

void add_scan(const RunData& run, FigureMaker& maker) {
  if (!run.sample_scan || run.sample_scan->find("feature_class") == nullptr) return;
  const std::vector<float> x = floats(*run.sample_scan, "x");
  const std::vector<float> y = floats(*run.sample_scan, "y");
  const std::vector<float> z = floats(*run.sample_scan, "z");
  std::vector<render::FeatureClass> classes;
  for (const float value : floats(*run.sample_scan, "feature_class")) {
    classes.push_back(static_cast<render::FeatureClass>(static_cast<std::uint8_t>(value)));
  }
  const std::size_t frame = run.record.at("frames").at("sample");
  maker.add("map", "scan-features",
            fmt::format("Frame {} as the estimator sees it: edge points mark corners and poles, "
                        "planar points walls and ground.",
                        frame),
            [&](const Style& style) {
              return render::scan_features(
                  {x, y, z, classes}, render::ScanView::kOblique,
                  maker.caption("One scan and its features",
                                fmt::format("frame {}, {} points", frame, count_text(x.size()))),
                  style);
            });
}

/// Stretches of time in which `flags` are not zero, half a frame to each side.
std::vector<render::Range> spans_where(const std::vector<double>& times,
                                       const std::vector<double>& flags) {
  std::vector<render::Range> spans;
  const double half = times.size() > 1 ? 0.5 * (times[1] - times[0]) : 0.05;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (flags[i] == 0) continue;
    if (!spans.empty() && spans.back().high >= times[i] - 1.5 * half) {
      spans.back().high = times[i] + half;
    } else {
      spans.push_back({times[i] - half, times[i] + half});
    }
  }
  return spans;
}

void add_health(const RunData& run, FigureMaker& maker) {
  if (!run.frames.has("residual_rms_m")) return;
  const std::vector<double> times = seconds_from_start(run);
  // The first frame is registered in nothing: its zeros are no measurements.
  const auto column = [&](const char* name) {
    std::vector<double> values = run.frames.column(name);
    if (!values.empty()) values.front() = std::numeric_limits<double>::quiet_NaN();
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
      });
}

void add_timing(const RunData& run, FigureMaker& maker) {
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

}  // namespace

std::vector<Figure> draw_figures(const RunData& run,
                                 const std::function<void(const std::string&)>& picture_drawn) {
  FigureMaker maker(run, picture_drawn);
  add_trajectories(run, maker);
  if (run.evaluation.comparison) {
    add_coloured_trajectory(run, maker);
    add_error_over_time(run, maker);
    if (run.evaluation.comparison->kitti) add_kitti_drift(*run.evaluation.comparison->kitti, maker);
  }
  if (run.map.size() > 0) add_maps(run, maker);
  add_scan(run, maker);
  add_health(run, maker);
  add_timing(run, maker);
  return maker.take();
}

}  // namespace traverse::report
