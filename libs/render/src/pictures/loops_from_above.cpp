#include "traverse/render/pictures/loops_from_above.hpp"

#include <vector>

#include "traverse/render/palette.hpp"

#include "pictures/trajectory_lines.hpp"
#include "plot/legend.hpp"
#include "plot/occupancy.hpp"
#include "plot/path.hpp"
#include "plot/scale_bar.hpp"
#include "plot/title_block.hpp"

namespace traverse::render {

namespace {

constexpr Colour kAccepted = palette::kGreen;
constexpr Colour kTurnedAway = palette::kOrange;

bool has(std::span<const LoopMark> loops, bool accepted) {
  for (const LoopMark& loop : loops) {
    if (loop.accepted == accepted) return true;
  }
  return false;
}

Path places(std::span<const LoopMark> loops) {
  Path path;
  for (const LoopMark& loop : loops) {
    path.positions.push_back(loop.keyframe_map);
    path.positions.push_back(loop.candidate_map);
  }
  path.distances.assign(path.positions.size(), 0);
  path.poses.assign(path.positions.size(), 0);
  return path;
}

}  // namespace

Drawing loops_from_above(const geometry::Trajectory& optimised,
                         const geometry::Trajectory* odometry, std::span<const LoopMark> loops,
                         const Caption& caption, const Style& style) {
  Canvas canvas(style);
  const Path way = path_of(optimised);
  const Path raw = odometry != nullptr ? path_of(*odometry) : Path{};
  const Path marks = places(loops);

  std::vector<LegendEntry> entries{{"optimised", palette::series(0), Sample::kLine}};
  if (!raw.empty()) entries.push_back({"odometry", palette::series(1), Sample::kLine});
  if (has(loops, true)) entries.push_back({"loop closed here", kAccepted, Sample::kPoint});
  if (has(loops, false)) entries.push_back({"rejected", kTurnedAway, Sample::kLine});

  const Rect page = draw_title_block(canvas, caption, "Loops from above");
  const Rect outer = draw_legend_above(canvas, entries, page, "y [m]");
  const PlotArea area = lay_out_from_above(canvas, outer, {&way, &raw});
  draw_axes(canvas, area);

  const std::vector<Point> ends = seen_from_above(marks, area);
  const double thin = 0.5 * canvas.sizes().line;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    if (!loops[k].accepted) canvas.straight(ends[2 * k], ends[2 * k + 1], kTurnedAway, thin);
  }
  Occupancy occupancy(style.width, style.height);
  if (!raw.empty()) draw_estimate(canvas, area, seen_from_above(raw, area), palette::series(1));
  const std::vector<Point> line = seen_from_above(way, area);
  occupancy.add_line(line);
  draw_estimate(canvas, area, line, palette::series(0));
  for (std::size_t k = 0; k < loops.size(); ++k) {
    if (loops[k].accepted) canvas.add(Disc{ends[2 * k], 1.6 * canvas.sizes().line, kAccepted, 1});
  }
  draw_scale_bar(canvas, area, occupancy);
  return std::move(canvas).finish();
}

}  // namespace traverse::render
