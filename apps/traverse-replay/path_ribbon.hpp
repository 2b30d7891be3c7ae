#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>
#include <mrpt/opengl/CSetOfTriangles.h>

#include "traverse/render/colour.hpp"

namespace traverse::app {

struct RibbonStyle {
  float width_m = 0.3F;
  render::Colour colour;
  bool dashed = false;
};

/// Draws a path as a flat ribbon, because OpenGL's core profile has no wide lines: every vertex
/// near the one numbered `near`, elsewhere so few that a path of any length is drawn quickly.
void draw_path(std::span<const Eigen::Vector3f> path, std::size_t near, const RibbonStyle& style,
               mrpt::opengl::CSetOfTriangles& ribbon);

}  // namespace traverse::app
