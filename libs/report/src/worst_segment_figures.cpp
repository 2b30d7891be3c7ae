#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "traverse/render/pictures/map_from_above.hpp"

#include "error_figures.hpp"
#include "number_text.hpp"

namespace traverse::report {

namespace {

constexpr double kSize = 0.6;     // of a full picture: a page has five of them
constexpr double kAround_m = 30;  // of the map around the segment

struct Points {
  std::vector<float> x, y, z;
};

/// The points of the map within kAround_m of the poses `first` to `last`, from above.
Points points_around(const Points& map, const geometry::Trajectory& way) {
  Eigen::Vector2d low = way.pose(0).translation.head<2>();
  Eigen::Vector2d high = low;
  for (const auto& pose : way.poses()) {
    low = low.cwiseMin(pose.translation.head<2>());
    high = high.cwiseMax(pose.translation.head<2>());
  }
  const Eigen::Vector2d margin(kAround_m, 0.6 * kAround_m);  // the picture is wider than high
  low -= margin;
  high += margin;
  Points near;
  for (std::size_t i = 0; i < map.x.size(); ++i) {
    const Eigen::Vector2d p(map.x[i], map.y[i]);
    if (!((p.array() >= low.array()).all() && (p.array() <= high.array()).all())) continue;
    near.x.push_back(map.x[i]);
    near.y.push_back(map.y[i]);
    near.z.push_back(map.z[i]);
  }
  return near;
}

geometry::Trajectory part_of(const geometry::Trajectory& trajectory, const WorstSegment& segment) {
  geometry::Trajectory part;
  for (std::size_t i = segment.first; i <= segment.last; ++i) {
    part.push_back(trajectory.stamp(i), trajectory.pose(i));
  }
  return part;
}

}  // namespace

void add_worst_segment_figures(const RunData& run, const WorstSegments& worst, FigureMaker& maker) {
  const auto floats = [&](const char* field) {
    const dataset::FieldValues* values = run.map.find(field);
    return values == nullptr ? std::vector<float>() : dataset::to_floats(*values);
  };
  const Points map{floats("x"), floats("y"), floats("z")};
  const std::vector<double> number = run.frames.column("frame");
  for (std::size_t k = 0; k < worst.segments.size(); ++k) {
    const WorstSegment& segment = worst.segments[k];
    const geometry::Trajectory way = part_of(run.estimate, segment);
    const Points near = points_around(map, way);
    const std::string frames =
        fmt::format("frames {} to {}", number[segment.first], number[segment.last]);
    maker.add_sized(
        "worst", fmt::format("worst-segment-{}", k + 1),
        fmt::format("Number {} of the worst segments, {}: the map around it, by height, and "
                    "the estimated way.",
                    k + 1, frames),
        [&](const render::Style& style) {
          return render::map_from_above(
              {near.x, near.y, near.z, Eigen::Vector3d::Zero()}, {}, &way,
              maker.caption(fmt::format("Worst segment {}", k + 1),
                            fmt::format("{}: {} {} {}", frames, worst.measure,
                                        short_number(segment.value), worst.unit)),
              style);
        },
        {}, kSize);
  }
}

}  // namespace traverse::report
