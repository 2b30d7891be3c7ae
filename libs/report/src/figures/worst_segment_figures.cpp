#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "traverse/render/pictures/map_from_above.hpp"
#include "traverse/render/pictures/scan_matches.hpp"

#include "run/number_texts.hpp"
#include "sections/error_figures.hpp"

namespace traverse::report {

namespace {

constexpr double kSize = 0.6;     // of a full picture: a page has five of them
constexpr double kAround_m = 30;  // of the map around the segment

struct Points {
  std::vector<float> x, y, z;

  void add(float px, float py, float pz) {
    x.push_back(px);
    y.push_back(py);
    z.push_back(pz);
  }
  render::MapPoints shown() const { return {x, y, z, Eigen::Vector3d::Zero()}; }
};

struct MatchedPoints {
  Points points;
  std::vector<float> offset_x, offset_y, offset_z;

  std::size_t size() const { return points.x.size(); }
  render::Matches shown() const { return {points.shown(), offset_x, offset_y, offset_z}; }
};

/// How a frame was registered: its part of worst_frames.ply.
struct RegisteredFrame {
  Points scan;
  MatchedPoints on_lines, on_planes;
};

std::vector<float> floats_or_zeros(const dataset::PointCloud& cloud, const std::string& field) {
  const dataset::FieldValues* values = cloud.find(field);
  return values == nullptr ? std::vector<float>(cloud.size(), 0) : dataset::to_floats(*values);
}

std::map<std::size_t, RegisteredFrame> registered_frames(const RunData& run) {
  std::map<std::size_t, RegisteredFrame> frames;
  if (!run.worst_frames || run.worst_frames->find("frame") == nullptr) return frames;
  const dataset::PointCloud& cloud = *run.worst_frames;
  const std::vector<double> number = dataset::to_doubles(*cloud.find("frame"));
  const auto x = floats_or_zeros(cloud, "x");
  const auto y = floats_or_zeros(cloud, "y");
  const auto z = floats_or_zeros(cloud, "z");
  const auto kind = floats_or_zeros(cloud, "kind");
  const std::array offset{floats_or_zeros(cloud, "offset_x"), floats_or_zeros(cloud, "offset_y"),
                          floats_or_zeros(cloud, "offset_z")};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    RegisteredFrame& frame = frames[static_cast<std::size_t>(number[i])];
    if (kind[i] == 0) {
      frame.scan.add(x[i], y[i], z[i]);
      continue;
    }
    MatchedPoints& matches = kind[i] == 1 ? frame.on_lines : frame.on_planes;
    matches.points.add(x[i], y[i], z[i]);
    matches.offset_x.push_back(offset[0][i]);
    matches.offset_y.push_back(offset[1][i]);
    matches.offset_z.push_back(offset[2][i]);
  }
  return frames;
}

geometry::Trajectory part_of(const geometry::Trajectory& trajectory,
                             const evaluation::WorstSegment& segment) {
  geometry::Trajectory part;
  for (std::size_t i = segment.first; i <= segment.last; ++i) {
    part.push_back(trajectory.stamp(i), trajectory.pose(i));
  }
  return part;
}

/// One of the worst segments, for the pictures of it.
struct Shown {
  std::size_t place = 0;  ///< 1: the worst
  std::string frames;     ///< "frames 40 to 50"
  std::string value;      ///< "RPE over 10 frames 0.3 m"
  geometry::Trajectory way;

  std::string picture() const { return fmt::format("worst-segment-{}", place); }
  std::string title() const { return fmt::format("Worst segment {}", place); }
};

/// The frame of the segment that was kept, or null.
const std::pair<const std::size_t, RegisteredFrame>* frame_in(
    const std::map<std::size_t, RegisteredFrame>& frames, double first, double last) {
  const auto found = std::find_if(frames.begin(), frames.end(), [&](const auto& frame) {
    const auto number = static_cast<double>(frame.first);
    return number > first && number <= last;
  });
  return found == frames.end() ? nullptr : &*found;
}

void add_registration(const Shown& shown, std::size_t number, const RegisteredFrame& frame,
                      FigureMaker& maker) {
  const std::size_t lines = frame.on_lines.size();
  const std::size_t planes = frame.on_planes.size();
  const std::string how =
      lines + planes == 0
          ? std::string("its scan, thinned; this estimator does not keep its matches")
          : fmt::format("its scan and its matches, {} on lines and {} on planes, thinned", lines,
                        planes);
  maker.add_sized(
      "worst", shown.picture(),
      fmt::format("Number {} of the worst segments, {}. Frame {}: {}.", shown.place, shown.frames,
                  number, how),
      [&](const render::Style& style) {
        return render::scan_matches(
            {frame.scan.shown(), frame.on_lines.shown(), frame.on_planes.shown()}, shown.way,
            maker.caption(fmt::format("{}: frame {}", shown.title(), number),
                          fmt::format("{}: {}", shown.frames, shown.value)),
            style);
      },
      {}, kSize);
}

/// The points of the map within kAround_m of the way.
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
    near.add(map.x[i], map.y[i], map.z[i]);
  }
  return near;
}

void add_map_around(const Shown& shown, const Points& map, FigureMaker& maker) {
  const Points near = points_around(map, shown.way);
  maker.add_sized(
      "worst", shown.picture(),
      fmt::format("Number {} of the worst segments, {}: the map around it, by height, and the "
                  "estimated trajectory.",
                  shown.place, shown.frames),
      [&](const render::Style& style) {
        return render::map_from_above(
            near.shown(), {}, &shown.way,
            maker.caption(shown.title(), fmt::format("{}: {}", shown.frames, shown.value)), style);
      },
      {}, kSize);
}

}  // namespace

void add_worst_segment_figures(const RunData& run, const evaluation::WorstSegments& worst,
                               FigureMaker& maker) {
  const std::map<std::size_t, RegisteredFrame> frames = registered_frames(run);
  const Points map{floats(run.map, "x"), floats(run.map, "y"), floats(run.map, "z")};
  const std::vector<double> number = run.frames.column("frame");
  for (std::size_t k = 0; k < worst.segments.size(); ++k) {
    const evaluation::WorstSegment& segment = worst.segments[k];
    const double first = number[segment.first];
    const double last = number[segment.last];
    const Shown shown{
        k + 1, fmt::format("frames {} to {}", first, last),
        fmt::format("{} {} {}", worst.measure, short_number(segment.value), worst.unit),
        part_of(run.estimate, segment)};
    if (const auto* frame = frame_in(frames, first, last)) {
      add_registration(shown, frame->first, frame->second, maker);
    } else {
      add_map_around(shown, map, maker);
    }
  }
}

}  // namespace traverse::report
