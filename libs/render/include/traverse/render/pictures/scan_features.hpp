#pragma once

#include <cstdint>
#include <span>

#include "traverse/render/caption.hpp"
#include "traverse/render/drawing.hpp"
#include "traverse/render/style.hpp"

namespace traverse::render {

/// LOAM's classes of points by curvature.
enum class FeatureClass : std::uint8_t { kOther, kSharp, kLessSharp, kFlat, kLessFlat };

/// A lidar scan in the sensor's frame (x forward, y left, z up), metres.
struct ScanPoints {
  std::span<const float> x, y, z;
  std::span<const FeatureClass> classes;  ///< one a point
};

enum class ScanView {
  kOblique,  ///< from behind and above, in perspective: what the features lie on can be seen
  kAbove,    ///< true to scale, forward to the right
};

/// One scan with its features, over rings of range every ten metres.
/// \throws std::invalid_argument if the arrays do not agree in size.
Drawing scan_features(const ScanPoints& scan, ScanView view, const Caption& caption,
                      const Style& style);

}  // namespace traverse::render
