#pragma once

#include <nanogui/theme.h>

#include <mrpt/img/TColor.h>

#include "traverse/render/colour.hpp"

namespace traverse::app {

/// The window in the colours of the project's dark theme.
nanogui::ref<nanogui::Theme> window_theme(NVGcontext* context);

nanogui::Color to_nanogui(render::Colour colour, float opacity = 1);
NVGcolor to_nanovg(render::Colour colour, float opacity = 1);
mrpt::img::TColor to_mrpt(render::Colour colour);

}  // namespace traverse::app
