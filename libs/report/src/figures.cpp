#include "figures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "traverse/render/pictures/map_from_above.hpp"
#include "traverse/render/pictures/map_in_perspective.hpp"
#include "traverse/render/pictures/scan_features.hpp"
#include "traverse/render/pictures/stage_times.hpp"
#include "traverse/render/pictures/time_series.hpp"
#include "traverse/render/pictures/trajectory_from_above.hpp"
#include "traverse/render/pictures/trajectory_from_the_side.hpp"

#include "error_figures.hpp"
#include "figure_maker.hpp"
#include "loop_figures.hpp"
#include "nearest_pose.hpp"
#include "number_text.hpp"
#include "series.hpp"

namespace traverse::report {

namespace {

using render::Style;

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
  maker.add(
      "trajectory", "trajectory-above", "The way from above" + against + ".",
      [&](const Style& style) {
        return render::trajectory_from_above(
            named, reference, maker.caption("Trajectory from above", path_statistic(run)), style);
      },
      "3d");
  maker.add("trajectory", "trajectory-side", "Height over the distance travelled" + against + ".",
            [&](const Style& style) {
              return render::trajectory_from_the_side(
                  named, reference, maker.caption("Trajectory from the side", path_statistic(run)),
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

/// The points between two heights above the sensor where it passed nearest: a plan of what stands
/// beside the way, on slopes too.
struct Slice {
  std::vector<float> x, y, z;
};

Slice slice_of(const RunData& run, const std::vector<float>& x, const std::vector<float>& y,
               const std::vector<float>& z, double low_m, double high_m) {
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Eigen::Vector3f p(x[i], y[i], z[i]);
    if (p.allFinite()) points.push_back(p);
  }
  const std::size_t stride = 1 + run.estimate.size() / std::numeric_limits<std::uint16_t>::max();
  const std::vector<std::uint16_t> nearest = nearest_poses(points, run.estimate, stride);
  Slice slice;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double above =
        double{points[i].z()} - run.estimate.pose(nearest[i] * stride).translation.z();
    if (above < low_m || above > high_m) continue;
    slice.x.push_back(points[i].x());
    slice.y.push_back(points[i].y());
    slice.z.push_back(points[i].z());
  }
  return slice;
}

void add_slice(const RunData& run, const std::vector<float>& x, const std::vector<float>& y,
               const std::vector<float>& z, FigureMaker& maker) {
  constexpr double kLow_m = -0.5;
  constexpr double kHigh_m = 0.5;
  const Slice slice = slice_of(run, x, y, z, kLow_m, kHigh_m);
  maker.add("map", "map-slice",
            "A slice of the map at the height of the sensor, half a metre up and down: walls and "
            "poles that several scans put in one place are thin.",
            [&](const Style& style) {
              return render::map_from_above(
                  {slice.x, slice.y, slice.z, Eigen::Vector3d::Zero()}, {}, &run.estimate,
                  maker.caption("Slice of the map at the height of the sensor",
                                fmt::format("{} of {} points, ±0.5 m", count_text(slice.x.size()),
                                            count_text(x.size()))),
                  style);
            });
}

void add_maps(const RunData& run, FigureMaker& maker) {
  const std::vector<float> x = floats(run.map, "x");
  const std::vector<float> y = floats(run.map, "y");
  const std::vector<float> z = floats(run.map, "z");
  const std::vector<float> intensity = floats(run.map, "intensity");
  const render::MapPoints points{x, y, z, Eigen::Vector3d::Zero()};
  maker.add(
      "map", "map-height", "The map from above, coloured by height, with the way in it.",
      [&](const Style& style) {
        return render::map_from_above(points, {}, &run.estimate,
                                      maker.caption("Map by height", map_statistic(run)), style);
      },
      "3d");
  maker.add(
      "map", "map-perspective", "The map from the side and above, coloured by height.",
      [&](const Style& style) {
        return render::map_in_perspective(points, {}, run.estimate,
                                          maker.caption("Map in perspective", map_statistic(run)),
                                          style);
      },
      "3d");
  add_slice(run, x, y, z, maker);
  const auto [least, most] = std::minmax_element(intensity.begin(), intensity.end());
  if (intensity.empty() || *least == *most) return;
  const render::PointValues by_intensity{intensity, "intensity", "", render::ColourMap::kCividis};
  maker.add(
      "map", "map-intensity", "The same map, coloured by the strength of the returns.",
      [&](const Style& style) {
        return render::map_from_above(points, by_intensity, &run.estimate,
                                      maker.caption("Map by intensity", map_statistic(run)), style);
      },
      "3d");
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
      },
      "charts");
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

std::vector<Figure> draw_figures(const RunData& run, const WorstSegments& worst, int width,
                                 const std::function<void(const std::string&)>& picture_drawn) {
  FigureMaker maker(run, width, picture_drawn);
  add_trajectories(run, maker);
  add_loop_figures(run, maker);
  if (run.evaluation.comparison) add_error_figures(run, maker);
  add_worst_segment_figures(run, worst, maker);
  if (run.map.size() > 0) add_maps(run, maker);
  add_scan(run, maker);
  add_health(run, maker);
  add_timing(run, maker);
  return maker.take();
}

}  // namespace traverse::report
