#include "figures/map_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "traverse/render/pictures/map_from_above.hpp"
#include "traverse/render/pictures/map_in_perspective.hpp"
#include "traverse/render/pictures/scan_features.hpp"

#include "charts/series.hpp"
#include "run/nearest_pose.hpp"
#include "run/number_texts.hpp"

namespace traverse::report {

namespace {

using render::Style;

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

/// Where the lidar is on the vehicle, metres, body frame.
Eigen::Vector3d lidar_in_body(const RunData& run) {
  for (const auto& sensor : run.record.at("recording").at("sensors")) {
    if (sensor.at("kind") != "lidar" || !sensor.contains("p_body_m")) continue;
    const auto& p = sensor.at("p_body_m");
    return Eigen::Vector3d(p.at(0), p.at(1), p.at(2));
  }
  return Eigen::Vector3d::Zero();
}

/// The heights of points above the sensor where it passed nearest to them.
std::vector<double> heights_above_way(const RunData& run, const std::vector<float>& x,
                                      const std::vector<float>& y, const std::vector<float>& z) {
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Eigen::Vector3f p(x[i], y[i], z[i]);
    points.push_back(p.allFinite() ? p : Eigen::Vector3f::Zero());
  }
  const std::size_t stride = 1 + run.estimate.size() / std::numeric_limits<std::uint16_t>::max();
  const std::vector<std::uint16_t> nearest = nearest_poses(points, run.estimate, stride);
  const Eigen::Vector3d p_body = lidar_in_body(run);
  std::vector<double> heights;
  for (std::size_t i = 0; i < points.size(); ++i) {
    heights.push_back(double{z[i]} - (run.estimate.pose(nearest[i] * stride) * p_body).z());
  }
  return heights;
}

struct SliceAt {
  const char* name;   ///< of the picture
  double height_m;    ///< above the sensor
  const char* where;  ///< "at the height of the sensor"
  const char* shows;
};
constexpr std::array<SliceAt, 2> kSlices{
    {{"map-slice", 0, "at the height of the sensor",
      "walls and poles that several scans put in one place are thin."},
     {"map-slice-above", 2, "two metres above the sensor",
      "above cars and people only what stays is left: walls, poles and crowns of trees."}}};
constexpr double kHalfSlice_m = 0.5;

void add_slices(const RunData& run, const std::vector<float>& x, const std::vector<float>& y,
                const std::vector<float>& z, FigureMaker& maker) {
  const std::vector<double> heights = heights_above_way(run, x, y, z);
  for (const SliceAt& at : kSlices) {
    Slice slice;
    for (std::size_t i = 0; i < heights.size(); ++i) {
      if (!(std::abs(heights[i] - at.height_m) <= kHalfSlice_m)) continue;
      slice.x.push_back(x[i]);
      slice.y.push_back(y[i]);
      slice.z.push_back(z[i]);
    }
    if (slice.x.empty()) continue;
    maker.add(
        "map", at.name,
        fmt::format("A slice of the map {}, half a metre up and down: {}", at.where, at.shows),
        [&](const Style& style) {
          return render::map_from_above(
              {slice.x, slice.y, slice.z, Eigen::Vector3d::Zero()}, {}, &run.estimate,
              maker.caption(fmt::format("Slice of the map {}", at.where),
                            fmt::format("{} of {} points, ±0.5 m", count_text(slice.x.size()),
                                        count_text(x.size()))),
              style, north_of_map(run));
        });
  }
}

void add_maps(const RunData& run, FigureMaker& maker) {
  const std::vector<float> x = floats(run.map, "x");
  const std::vector<float> y = floats(run.map, "y");
  const std::vector<float> z = floats(run.map, "z");
  const std::vector<float> intensity = floats(run.map, "intensity");
  const render::MapPoints points{x, y, z, Eigen::Vector3d::Zero()};
  maker.add(
      "map", "map-height", "The map from above, coloured by height, with the trajectory.",
      [&](const Style& style) {
        return render::map_from_above(points, {}, &run.estimate,
                                      maker.caption("Map by height", map_statistic(run)), style,
                                      north_of_map(run));
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
  add_slices(run, x, y, z, maker);
  const auto [least, most] = std::minmax_element(intensity.begin(), intensity.end());
  if (intensity.empty() || *least == *most) return;
  const render::PointValues by_intensity{intensity, "intensity", "", render::ColourMap::kCividis};
  maker.add(
      "map", "map-intensity", "The same map, coloured by the strength of the returns.",
      [&](const Style& style) {
        return render::map_from_above(points, by_intensity, &run.estimate,
                                      maker.caption("Map by intensity", map_statistic(run)), style,
                                      north_of_map(run));
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

}  // namespace

void add_map_figures(const RunData& run, FigureMaker& maker) {
  if (run.map.size() > 0) add_maps(run, maker);
  add_scan(run, maker);
}

}  // namespace traverse::report
