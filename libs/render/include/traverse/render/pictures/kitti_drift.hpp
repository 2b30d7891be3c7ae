#pragma once

#include <cstddef>
#include <span>

#include "traverse/render/caption.hpp"
#include "traverse/render/drawing.hpp"
#include "traverse/render/style.hpp"

namespace traverse::render {

/// The mean drift over all segments of one length, as the KITTI odometry benchmark defines it.
struct DriftAtLength {
  double length_m = 0;
  double translation_percent = 0;
  double rotation_deg_per_100m = 0;
  std::size_t segments = 0;
};

/// Translational and rotational drift over segment length, with the number of segments behind each
/// point and the mean over all segments.
Drawing kitti_drift(std::span<const DriftAtLength> drift, const Caption& caption,
                    const Style& style);

}  // namespace traverse::render
