#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace traverse::lidar {

/// What a point of a scan line looks like to LOAM. The order is that of the legend.
enum class FeatureClass : std::uint8_t {
  kNone,       ///< unusable: at the end of a line, occluded, grazing, or beside a picked point
  kSharp,      ///< the edge points of the largest curvature in their sector
  kLessSharp,  ///< further edge points
  kFlat,       ///< the planar points of the smallest curvature in their sector
  kLessFlat,   ///< all other points of low curvature
};
inline constexpr std::size_t kFeatureClasses = 5;
std::string_view name_of(FeatureClass feature_class);

}  // namespace traverse::lidar
