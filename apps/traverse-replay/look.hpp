#pragma once

#include <nanogui/theme.h>

#include <Eigen/Core>
#include <mrpt/img/TColor.h>
#include <mrpt/math/TPoint3D.h>
#include <mrpt/poses/CPose3D.h>

#include "traverse/geometry/pose3.hpp"
#include "traverse/render/colour.hpp"

namespace traverse::app {

/// The window in the colours of the project's dark theme.
nanogui::ref<nanogui::Theme> window_theme(NVGcontext* context);

nanogui::Color to_nanogui(render::Colour colour, float opacity = 1);
NVGcolor to_nanovg(render::Colour colour, float opacity = 1);
mrpt::img::TColor to_mrpt(render::Colour colour);
mrpt::math::TPoint3Df to_mrpt(const Eigen::Vector3f& p);
mrpt::poses::CPose3D to_mrpt(const geometry::Pose3& pose);

}  // namespace traverse::app
