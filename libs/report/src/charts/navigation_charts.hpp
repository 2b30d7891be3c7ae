#pragma once

#include "traverse/pipeline/frame_table.hpp"

#include "run/model.hpp"

namespace traverse::report {

/// The charts of section "navigation", where the run is one of navigation.
void add_navigation_charts(const pipeline::FrameTable& frames, Json& charts);

}  // namespace traverse::report
