#pragma once

#include <string>

#include "traverse/render/drawing.hpp"

/// Drawings as vector graphics, for paper.
namespace traverse::render {

/// Whether a drawing consists of lines, areas and texts alone.
bool is_vector(const Drawing& drawing);

/// The bytes of an SVG file, one unit a pixel, texts as outlines of the fonts that pictures use.
/// \throws std::invalid_argument if the drawing has a point cloud.
std::string encode_svg(const Drawing& drawing);

/// The bytes of a PDF file of one page, 96 pixels an inch, fonts embedded. \throws as above
std::string encode_pdf(const Drawing& drawing);

}  // namespace traverse::render
