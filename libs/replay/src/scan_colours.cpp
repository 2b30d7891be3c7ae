#include "traverse/replay/scan_colours.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "traverse/lidar/feature_class.hpp"
#include "traverse/render/colour_map.hpp"
#include "traverse/render/palette.hpp"
#include "traverse/render/theme.hpp"
#include "traverse/statistics/quantile.hpp"

namespace traverse::replay {

using render::Colour;

namespace {

constexpr double kClipped = 0.02;  // of the values, at each end
constexpr std::size_t kShades = 256;
constexpr int kResidualShades = 16;  // on each side of zero, in the legend

struct Span {
  double least = 0;
  double most = 1;
};

Span percentiles(const std::vector<float>& values) {
  return {statistics::quantile(values, kClipped), statistics::quantile(values, 1 - kClipped)};
}

ScanColours grey(std::size_t count, std::string title) {
  return {std::vector<Colour>(count, render::dark_theme().other), {std::move(title), {}, {}}};
}

std::string in_unit(std::string_view what, std::string_view unit) {
  return unit.empty() ? std::string(what) : fmt::format("{} [{}]", what, unit);
}

ScanColours scaled(const std::vector<float>& values, std::size_t count, render::ColourMap map,
                   std::string_view what, std::string_view unit) {
  if (values.size() != count || count == 0) {
    return grey(count, fmt::format("{}: not known for this scan", what));
  }
  const Span span = percentiles(values);
  std::array<Colour, kShades> shades;
  for (std::size_t k = 0; k < kShades; ++k) {
    shades[k] = render::colour_at(map, static_cast<double>(k) / (kShades - 1));
  }
  const double width = std::max(span.most - span.least, 1e-9);
  ScanColours result;
  result.legend = {in_unit(what, unit) + ", 2nd to 98th percentile",
                   {shades.begin(), shades.end()},
                   {fmt::format("{:.3g}", span.least), fmt::format("{:.3g}", span.most)}};
  result.colours.reserve(count);
  for (const float value : values) {
    const double share = std::clamp((value - span.least) / width, 0.0, 1.0);
    result.colours.push_back(shades[static_cast<std::size_t>(share * (kShades - 1))]);
  }
  return result;
}

ScanColours by_class(const ShownScan& scan) {
  const std::size_t count = scan.points_body.size();
  if (scan.feature_class.size() != count) {  // a 2-D laser's, say: to be seen before the map
    const Colour plain = render::palette::kOrange;
    return {std::vector<Colour>(count, plain), {"class: not known for this scan", {plain}, {""}}};
  }
  const std::array<Colour, lidar::kFeatureClasses> colours{
      render::dark_theme().other, render::palette::kSharp, render::palette::kLessSharp,
      render::palette::kFlat, render::palette::kLessFlat};
  ScanColours result;
  result.legend = {"class of the point",
                   {colours.begin(), colours.end()},
                   {"other", "sharp", "less sharp", "flat", "less flat"}};
  result.colours.reserve(count);
  for (const std::uint8_t c : scan.feature_class) {
    result.colours.push_back(colours.at(c < colours.size() ? c : 0));
  }
  return result;
}

std::vector<float> heights(const ShownScan& scan) {
  std::vector<float> values;
  values.reserve(scan.points_body.size());
  for (const Eigen::Vector3f& p : scan.points_body) values.push_back(p.z());
  return values;
}

}  // namespace

std::string_view name_of(ScanColour colour) {
  for (const auto& [name, value] : kScanColourNames) {
    if (value == colour) return name;
  }
  return {};
}

std::optional<ScanColour> scan_colour_named(std::string_view name) {
  for (const auto& [known, value] : kScanColourNames) {
    if (known == name) return value;
  }
  return std::nullopt;
}

ScanColours colours_of(const ShownScan& scan, ScanColour by) {
  using render::ColourMap;
  const std::size_t count = scan.points_body.size();
  switch (by) {
    case ScanColour::kClass:
      return by_class(scan);
    case ScanColour::kRing:
      return scaled(scan.ring, count, ColourMap::kViridis, "ring", "");
    case ScanColour::kTime:
      return scaled(scan.time_s, count, ColourMap::kViridis, "time after the stamp", "s");
    case ScanColour::kHeight:
      return scaled(heights(scan), count, ColourMap::kViridis, "height", "m");
    case ScanColour::kIntensity:
      return scaled(scan.intensity, count, ColourMap::kCividis, "intensity", "");
    case ScanColour::kResidual: {
      ScanColours result = grey(count, "residual of the matched points [m]; all others grey");
      for (int k = -kResidualShades; k <= kResidualShades; ++k) {
        result.legend.samples.push_back(residual_colour(kResidualScale * k / kResidualShades));
      }
      result.legend.labels = {fmt::format("-{:g}", kResidualScale),
                              fmt::format("{:g}", kResidualScale)};
      return result;
    }
  }
  return grey(count, "");
}

Colour residual_colour(double residual_m) {
  return render::colour_at(render::ColourMap::kDiverging,
                           0.5 + 0.5 * std::clamp(residual_m / kResidualScale, -1.0, 1.0));
}

}  // namespace traverse::replay
