#pragma once

#include "traverse/render/rect.hpp"

#include "gl/functions.hpp"

namespace traverse::render::gl {

/// Device pixels to a pixel of the picture, each way.
inline constexpr int kSupersampling = 2;

/// The part of a picture that is drawn at once: whole pixels of the picture.
struct Tile {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;

  int device_width() const { return kSupersampling * width; }
  int device_height() const { return kSupersampling * height; }
};

/// A rectangle in the tile, device pixels.
struct DeviceRect {
  GLint left, top, right, bottom;
};

/// The part of `rect`, given in the picture, that lies in the tile, on whole device pixels.
DeviceRect in_tile(const Tile& tile, const Rect& rect);

/// Restricts drawing to `rect`. With several samples a pixel, llvmpipe lets samples of the
/// neighbouring pixels through: where that matters, shaders look for themselves.
void scissor(const Functions& gl, const DeviceRect& rect);

}  // namespace traverse::render::gl
