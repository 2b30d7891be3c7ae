#include "traverse/render/pictures/scan_features.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "traverse/render/palette.hpp"
#include "traverse/render/plot/range.hpp"

#include "pictures/note.hpp"
#include "plot/legend.hpp"
#include "plot/number_text.hpp"
#include "plot/plot_area.hpp"
#include "plot/title_block.hpp"

namespace traverse::render {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRingStep = 10;       // metres
constexpr double kLargestShown = 60;   // metres: beyond, a scan is too thin to read
constexpr double kSmallestShown = 10;  // metres
constexpr double kRingsShown = 1.5;    // of the range shown
constexpr double kAboveShown = 0.65;   // of the range, up and down: to the sides there is more room
constexpr double kGroundPercent = 10;  // of the heights: above stray points below the road

/// A class, its look, and its points. In the order of drawing: what matters most comes last.
struct Layer {
  FeatureClass feature;
  const char* name;
  double diameter;  // of a line's width
  Colour colour;
  std::vector<ScenePoint> points;
};

std::vector<Layer> layers_of(const ScanPoints& scan, const Theme& theme) {
  std::vector<Layer> layers{{FeatureClass::kOther, "other", 0.9, theme.other, {}},
                            {FeatureClass::kLessFlat, "less flat", 0.9, palette::kLessFlat, {}},
                            {FeatureClass::kFlat, "flat", 2.2, palette::kFlat, {}},
                            {FeatureClass::kLessSharp, "less sharp", 1.8, palette::kLessSharp, {}},
                            {FeatureClass::kSharp, "sharp", 2.6, palette::kSharp, {}}};
  for (std::size_t i = 0; i < scan.x.size(); ++i) {
    if (!std::isfinite(scan.x[i]) || !std::isfinite(scan.y[i]) || !std::isfinite(scan.z[i])) {
      continue;
    }
    const auto layer = std::find_if(layers.begin(), layers.end(), [&](const Layer& candidate) {
      return candidate.feature == scan.classes[i];
    });
    if (layer == layers.end()) continue;
    layer->points.push_back({scan.x[i], scan.y[i], scan.z[i], layer->colour});
  }
  return layers;
}

std::vector<LegendEntry> legend_of(const std::vector<Layer>& layers) {
  std::vector<LegendEntry> entries;
  for (const char* name : {"sharp", "less sharp", "flat", "less flat", "other"}) {
    const auto layer = std::find_if(layers.begin(), layers.end(), [&](const Layer& candidate) {
      return std::string(candidate.name) == name;
    });
    entries.push_back({std::string(name) + "  " + count_text(layer->points.size()), layer->colour,
                       Sample::kPoint});
  }
  return entries;
}

/// How far the picture reaches: to nearly all points, but not so far that the near ones get small.
double shown_range(const ScanPoints& scan) {
  std::vector<double> ranges;
  for (std::size_t i = 0; i < scan.x.size(); ++i) {
    ranges.push_back(std::hypot(scan.x[i], scan.y[i]));
  }
  const double most = percentile(ranges, 98);
  return std::isfinite(most) ? std::clamp(most, kSmallestShown, kLargestShown) : kSmallestShown;
}

/// Where the scene is seen: the camera and its place in the picture.
struct View {
  Camera camera;
  Rect viewport;

  Point at(const Eigen::Vector3d& p) const {
    if (camera.depth(p) < camera.near) {
      return {std::numeric_limits<double>::quiet_NaN(), 0};
    }
    return camera.project(p, viewport);
  }
};

View view_from_behind(const Rect& viewport, double range, double ground) {
  // High enough to look over the near cars, low enough to see walls and poles from the side.
  const Eigen::Vector3d eye(-0.62 * range, 0, ground + 0.55 * range);
  const Eigen::Vector3d target(0.16 * range, 0, ground);
  const double aspect = viewport.width() / viewport.height();
  // In a narrow picture the sides decide, so that they are not cut off.
  const double half_height = std::tan(25 * kPi / 180) * std::max(1.0, 1.2 / aspect);
  return {
      Camera::looking_at(eye, target, 2 * std::atan(half_height), aspect, 0.05 * range, 6 * range),
      viewport};
}

View view_from_above(const Rect& viewport, double range, const std::vector<Layer>& layers) {
  const double half_height = kAboveShown * range;
  const double half_width = half_height * viewport.width() / viewport.height();
  double lowest = 0;
  double highest = 0;
  for (const Layer& layer : layers) {
    for (const ScenePoint& p : layer.points) {
      lowest = std::min(lowest, static_cast<double>(p.z));
      highest = std::max(highest, static_cast<double>(p.z));
    }
  }
  return {Camera::from_above({0, 0}, half_width, half_height, lowest, highest), viewport};
}

void draw_rings(Canvas& canvas, const View& view, double range, double ground) {
  const Sizes& sizes = canvas.sizes();
  for (double radius = kRingStep; radius <= kRingsShown * range; radius += kRingStep) {
    Polyline ring;
    for (int i = 0; i <= 360; ++i) {
      const double angle = i * kPi / 180;
      ring.points.push_back(view.at({radius * std::cos(angle), radius * std::sin(angle), ground}));
    }
    ring.colour = canvas.theme().grid;
    ring.width = sizes.hairline;
    canvas.add(std::move(ring), view.viewport);
  }
}

/// To the right of the vehicle, where the rings are widest apart in both views, or else ahead.
void label_rings(Canvas& canvas, const View& view, double range, double ground) {
  const Sizes& sizes = canvas.sizes();
  for (double radius = kRingStep; radius <= kRingsShown * range; radius += kRingStep) {
    for (const Eigen::Vector3d& place :
         {Eigen::Vector3d(0, -radius, ground), Eigen::Vector3d(radius, 0, ground)}) {
      const Point at = view.at(place);
      const Text number =
          canvas.note(fixed_text(radius, 0) + " m", {at.x, at.y + kHalfDigit * sizes.tick},
                      HorizontalAlign::kCentre);
      const Text label = canvas.on_data(coloured(number, canvas.theme().text));
      const bool inside =
          std::isfinite(at.x) && view.viewport.contains(canvas.measure().box(label));
      if (inside && canvas.text(label)) break;
    }
  }
}

/// The sensor: a small triangle that points forward.
void draw_sensor(Canvas& canvas, const View& view, double range, double ground) {
  const double size = 0.012 * range;
  Polygon triangle{{}, canvas.theme().text, 1};
  for (const auto& [x, y] : std::array<std::pair<double, double>, 3>{
           {{1.4 * size, 0.0}, {-size, size}, {-size, -size}}}) {
    triangle.corners.push_back(view.at({x, y, ground}));
  }
  canvas.add(std::move(triangle), view.viewport);
}

void check_sizes(const ScanPoints& scan) {
  const std::size_t count = scan.x.size();
  if (scan.y.size() != count || scan.z.size() != count || scan.classes.size() != count) {
    throw std::invalid_argument("the arrays of a scan must agree in size");
  }
}

}  // namespace

Drawing scan_features(const ScanPoints& scan, ScanView view_kind, const Caption& caption,
                      const Style& style) {
  check_sizes(scan);
  Canvas canvas(style);
  const Sizes& sizes = canvas.sizes();
  std::vector<Layer> layers = layers_of(scan, style.theme);
  const double range = shown_range(scan);
  const double low = percentile(scan.z, kGroundPercent);
  const double ground = std::isfinite(low) ? low : 0;

  const Rect page = draw_title_block(canvas, caption, "Features of a scan");
  const std::vector<LegendEntry> legend = legend_of(layers);
  const Rect below = draw_legend_above(canvas, legend, page, "");
  const Rect viewport{page.left, below.top + Sizes::line_height(sizes.body) + sizes.gap, page.right,
                      page.bottom};
  const View view = view_kind == ScanView::kOblique ? view_from_behind(viewport, range, ground)
                                                    : view_from_above(viewport, range, layers);
  draw_rings(canvas, view, range, ground);
  if (scan.x.empty()) draw_note(canvas, viewport, "no points");
  for (Layer& layer : layers) {
    PointCloud cloud;
    cloud.points = std::move(layer.points);
    cloud.camera = view.camera;
    cloud.viewport = view.viewport;
    cloud.diameter = (view_kind == ScanView::kOblique ? 1.0 : 0.8) * layer.diameter * sizes.line;
    canvas.add(std::move(cloud), view.viewport);
  }
  draw_sensor(canvas, view, range, ground);
  label_rings(canvas, view, range, ground);
  return std::move(canvas).finish();
}

}  // namespace traverse::render
