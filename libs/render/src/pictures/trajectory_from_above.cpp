#include "traverse/render/pictures/trajectory_from_above.hpp"

#include <optional>
#include <vector>

#include "traverse/render/palette.hpp"

#include "pictures/trajectory_lines.hpp"
#include "plot/legend.hpp"
#include "plot/north_arrow.hpp"
#include "plot/number_text.hpp"
#include "plot/occupancy.hpp"
#include "plot/path.hpp"
#include "plot/scale_bar.hpp"
#include "plot/title_block.hpp"

namespace traverse::render {

namespace {

std::vector<LegendEntry> legend_of(std::span<const NamedTrajectory> estimates,
                                   const std::vector<Path>& paths, bool with_reference,
                                   const Theme& theme) {
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    entries.push_back({estimates[i].name, palette::series(i), Sample::kLine});
  }
  if (with_reference) entries.push_back({"reference", theme.reference, Sample::kDashedLine});
  if (paths.empty() || paths.front().empty()) return entries;
  entries.push_back({"start", palette::series(0), Sample::kStart});
  entries.push_back({"end", palette::series(0), Sample::kEnd});
  if (paths.front().length() > 0) {
    entries.push_back({"every 10 % of the path, " + value_text(paths.front().length() / 10) + " m",
                       theme.text, Sample::kTick});
  }
  return entries;
}

}  // namespace

Drawing trajectory_from_above(std::span<const NamedTrajectory> estimates,
                              const geometry::Trajectory* reference, const Caption& caption,
                              const Style& style, const std::optional<Eigen::Vector3d>& north) {
  Canvas canvas(style);
  std::vector<Path> paths;
  for (const NamedTrajectory& estimate : estimates) paths.push_back(path_of(*estimate.trajectory));
  const Path reference_path = reference != nullptr ? path_of(*reference) : Path{};

  const Rect page = draw_title_block(canvas, caption, "Trajectory from above");
  const Rect outer = draw_legend_above(
      canvas, legend_of(estimates, paths, !reference_path.empty(), style.theme), page, "y [m]");
  std::vector<const Path*> all{&reference_path};
  for (const Path& path : paths) all.push_back(&path);
  const PlotArea area = lay_out_from_above(canvas, outer, all);
  draw_axes(canvas, area);

  Occupancy occupancy(style.width, style.height);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::vector<Point> line = seen_from_above(paths[i], area);
    occupancy.add_line(line);
    draw_estimate(canvas, area, line, palette::series(i));
  }
  draw_reference(canvas, area, seen_from_above(reference_path, area));
  for (std::size_t i = 0; i < paths.size(); ++i) {
    draw_path_marks(canvas, seen_from_above(paths[i], area), paths[i], palette::series(i));
  }
  draw_scale_bar(canvas, area, occupancy);
  if (north) draw_north_arrow(canvas, area, *north, occupancy);
  return std::move(canvas).finish();
}

}  // namespace traverse::render
