#include "traverse/render/colour_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace traverse::render {

namespace {

using Table = std::array<Colour, 256>;

/// OpenCV carries the 256 published entries of matplotlib's viridis and cividis (both CC0).
Table table_of_opencv(int colour_map) {
  cv::Mat positions(1, 256, CV_8UC1);
  for (int i = 0; i < 256; ++i) positions.at<std::uint8_t>(0, i) = static_cast<std::uint8_t>(i);
  cv::Mat blue_green_red;
  cv::applyColorMap(positions, blue_green_red, colour_map);
  Table table;
  for (int i = 0; i < 256; ++i) {
    const auto& entry = blue_green_red.at<cv::Vec3b>(0, i);
    table.at(static_cast<std::size_t>(i)) = {entry[2], entry[1], entry[0]};
  }
  return table;
}

/// From one end over white to the other. Both ends have the lightness L* = 35, so that equal
/// residuals of either sign look equally strong.
Colour diverging(double share) {
  constexpr Colour kNegative = Colour::hex(0x00558C);
  constexpr Colour kPositive = Colour::hex(0x8F3700);
  constexpr Colour kWhite = Colour::hex(0xFFFFFF);
  const double strength = std::abs(2 * share - 1);
  return mix(kWhite, share < 0.5 ? kNegative : kPositive, strength);
}

}  // namespace

Colour colour_at(ColourMap map, double share) {
  static const Table kViridis = table_of_opencv(cv::COLORMAP_VIRIDIS);
  static const Table kCividis = table_of_opencv(cv::COLORMAP_CIVIDIS);
  if (std::isnan(share)) return Colour::hex(0x808080);
  const double clamped = std::clamp(share, 0.0, 1.0);
  if (map == ColourMap::kDiverging) return diverging(clamped);
  const auto entry = static_cast<std::size_t>(std::min(255.0, std::floor(clamped * 256)));
  return (map == ColourMap::kViridis ? kViridis : kCividis).at(entry);
}

}  // namespace traverse::render
