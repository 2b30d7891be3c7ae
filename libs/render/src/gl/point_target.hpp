#pragma once

#include "gl/functions.hpp"

namespace traverse::render::gl {

/// Where a point cloud is drawn by itself, with its depth. With the context current throughout.
class PointTarget {
 public:
  explicit PointTarget(const Functions& gl);

  /// Gives the buffers this size, unless they have it. \throws RendererError
  void resize(int width, int height);

  /// Binds it, sets the viewport to all of it, and clears it: transparent, infinitely far.
  void begin() const;
  /// Lets what is drawn next lie in front of what is there.
  void begin_layer() const;

  GLuint colour() const { return colour_; }  ///< texture RGBA8, alpha 0 where there is no point
  GLuint depth() const { return depth_; }    ///< texture R32F, metres from the eye

 private:
  const Functions& gl_;
  int width_ = 0;
  int height_ = 0;
  GLuint framebuffer_ = 0;
  GLuint colour_ = 0;
  GLuint depth_ = 0;
  GLuint depth_buffer_ = 0;
};

}  // namespace traverse::render::gl
