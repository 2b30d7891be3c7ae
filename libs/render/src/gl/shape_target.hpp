#pragma once

#include <opencv2/core.hpp>

#include "gl/functions.hpp"

namespace traverse::render::gl {

/// Where a tile is put together: four samples a pixel. With the context current throughout.
class ShapeTarget {
 public:
  explicit ShapeTarget(const Functions& gl);

  /// Gives the buffers this size, unless they have it; contents are undefined. \throws
  /// RendererError
  void resize(int width, int height);

  void bind() const;  ///< and sets the viewport to all of it

  /// The samples averaged: RGBA, the picture's top row first.
  cv::Mat read() const;

 private:
  const Functions& gl_;
  int width_ = 0;
  int height_ = 0;
  GLuint sampled_ = 0;
  GLuint sampled_colour_ = 0;
  GLuint averaged_ = 0;
  GLuint averaged_colour_ = 0;
};

}  // namespace traverse::render::gl
