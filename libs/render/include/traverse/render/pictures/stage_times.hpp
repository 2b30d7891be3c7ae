#pragma once

#include <optional>
#include <span>
#include <string>

#include "traverse/render/caption.hpp"
#include "traverse/render/drawing.hpp"
#include "traverse/render/style.hpp"

namespace traverse::render {

/// How long a step of the work on a frame takes, over all frames.
struct StageTime {
  std::string name;
  double median_ms = 0;
  double p95_ms = 0;
};

/// A bar for each stage, in the order of the work, up to its median, with a line to its 95th
/// percentile; and one for the whole frame, if given.
Drawing stage_times(std::span<const StageTime> stages, const std::optional<StageTime>& frame,
                    const Caption& caption, const Style& style);

}  // namespace traverse::render
