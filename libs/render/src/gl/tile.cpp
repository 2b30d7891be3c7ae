#include "gl/tile.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::render::gl {

DeviceRect in_tile(const Tile& tile, const Rect& rect) {
  const auto device = [](double picture, int origin, int size) {
    const double position = std::round(kSupersampling * (picture - origin));
    return static_cast<GLint>(std::clamp(position, 0.0, double{kSupersampling} * size));
  };
  const GLint left = device(rect.left, tile.left, tile.width);
  const GLint top = device(rect.top, tile.top, tile.height);
  return {left, top, std::max(left, device(rect.right, tile.left, tile.width)),
          std::max(top, device(rect.bottom, tile.top, tile.height))};
}

void scissor(const Functions& gl, const DeviceRect& rect) {
  gl.Scissor(rect.left, rect.top, rect.right - rect.left, rect.bottom - rect.top);
}

}  // namespace traverse::render::gl
