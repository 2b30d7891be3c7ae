#include "traverse/render/pictures/trajectory_from_the_side.hpp"

#include <optional>
#include <vector>

#include "traverse/render/palette.hpp"

#include "pictures/trajectory_lines.hpp"
#include "plot/decimation.hpp"
#include "plot/legend.hpp"
#include "plot/markers.hpp"
#include "plot/number_text.hpp"
#include "plot/path.hpp"
#include "plot/title_block.hpp"

namespace traverse::render {

namespace {

constexpr double kLeastHeight = 0.2;  // metres: noise on flat ground is not magnified to hills
constexpr double kRoom = 0.08;

PlotArea lay_out_profile(const Canvas& canvas, const Rect& outer,
                         const std::vector<const Path*>& paths) {
  double longest = 0;
  std::optional<Range> heights;
  for (const Path* path : paths) {
    if (path->empty()) continue;
    longest = std::max(longest, path->length());
    const Range z = bounds_of(*path).z;
    heights = heights ? heights->joined(z) : z;
  }
  return lay_out(canvas, outer, {"distance travelled", "m", Range{0, longest}.padded(0.01)},
                 {"height z", "m", heights.value_or(Range{}).at_least(kLeastHeight).padded(kRoom)});
}

std::vector<Point> profile(const Path& path, const PlotArea& area) {
  std::vector<Point> line;
  for (std::size_t i = 0; i < path.positions.size(); ++i) {
    line.push_back(area.at(path.distances[i], path.positions[i].z()));
  }
  return line;
}

void draw_ends(Canvas& canvas, const Path& path, const PlotArea& area, Colour colour) {
  if (path.empty()) return;
  const auto at = [&](std::size_t i) { return area.at(path.distances[i], path.positions[i].z()); };
  draw_end(canvas, at(path.last_finite()), colour);
  draw_start(canvas, at(path.first_finite()), colour);
}

void state_exaggeration(Canvas& canvas, const PlotArea& area) {
  const double factor = area.pixels_per_y() / area.pixels_per_x();
  const std::string text = factor >= 1.05
                               ? "heights exaggerated " + value_text(factor, 2) + " times"
                               : "heights compressed " + value_text(1 / factor, 2) + " times";
  canvas.text(
      canvas.note(text, {area.rect.right, x_name_baseline(canvas, area)}, HorizontalAlign::kRight));
}

}  // namespace

Drawing trajectory_from_the_side(std::span<const NamedTrajectory> estimates,
                                 const geometry::Trajectory* reference, const Caption& caption,
                                 const Style& style) {
  Canvas canvas(style);
  std::vector<Path> paths;
  std::vector<LegendEntry> legend;
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    paths.push_back(path_of(*estimates[i].trajectory));
    legend.push_back({estimates[i].name, palette::series(i), Sample::kLine});
  }
  const Path reference_path = reference != nullptr ? path_of(*reference) : Path{};
  if (!reference_path.empty()) {
    legend.push_back({"reference", style.theme.reference, Sample::kDashedLine});
  }
  legend.push_back({"start", palette::series(0), Sample::kStart});
  legend.push_back({"end", palette::series(0), Sample::kEnd});

  const Rect page = draw_title_block(canvas, caption, "Trajectory from the side");
  const Rect outer = draw_legend_above(canvas, legend, page, "height z [m]");
  std::vector<const Path*> all{&reference_path};
  for (const Path& path : paths) all.push_back(&path);
  const PlotArea area = lay_out_profile(canvas, outer, all);
  draw_axes(canvas, area);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    draw_estimate(canvas, area, decimated(profile(paths[i], area)), palette::series(i));
  }
  draw_reference(canvas, area, decimated(profile(reference_path, area)));
  for (std::size_t i = 0; i < paths.size(); ++i) {
    draw_ends(canvas, paths[i], area, palette::series(i));
  }
  state_exaggeration(canvas, area);
  return std::move(canvas).finish();
}

}  // namespace traverse::render
