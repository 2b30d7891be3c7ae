#pragma once

#include <cstdint>
#include <span>

#include "gl/functions.hpp"
#include "gl/tile.hpp"

namespace traverse::render {

/// A corner of a triangle, picture pixels.
struct ShapeVertex {
  float x = 0;
  float y = 0;
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  std::uint8_t alpha = 0;
};

namespace gl {

/// Draws flat triangles. With the context current throughout.
class ShapePass {
 public:
  explicit ShapePass(const Functions& gl);

  void upload(std::span<const ShapeVertex> vertices);
  /// Draws `count` of the uploaded vertices, three a triangle, into what is bound, inside `clip`.
  void draw(const Tile& tile, const DeviceRect& clip, std::size_t first, std::size_t count) const;

 private:
  const Functions& gl_;
  GLuint program_;
  GLint picture_to_clip_;
  GLint visible_;
  GLuint vertex_array_ = 0;
  GLuint buffer_ = 0;
};

}  // namespace gl
}  // namespace traverse::render
