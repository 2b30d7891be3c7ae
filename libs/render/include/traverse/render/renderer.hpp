#pragma once

#include <memory>
#include <stdexcept>

#include "traverse/render/drawing.hpp"
#include "traverse/render/image.hpp"

namespace traverse::render {

/// The off-screen OpenGL cannot be had or refuses a step.
class RendererError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Turns drawings into images, off screen, without a display or a graphics card.
///
/// Lines, discs and polygons are anti-aliased with sixteen samples a pixel, points with four. The
/// same drawing gives the same bytes on every repeat and for any number of threads.
///
/// Each renderer has an OpenGL context of its own, and threads of its own to use it in. It may be
/// called from any thread, one at a time, also from one in which another library draws.
class Renderer {
 public:
  struct Options {
    /// Larger pictures are drawn in tiles, to bound the memory (about 230 MB for the default) and
    /// because OpenGL has a largest size. Pixels of the finished image.
    int tile_width = 2048;
    int tile_height = 1152;
  };

  Renderer() : Renderer(Options{}) {}
  /// \throws std::invalid_argument if a tile is larger than OpenGL allows (8160 pixels) or empty;
  /// RendererError if there is no OSMesa to draw with; files::InputError if a font file is
  /// missing.
  explicit Renderer(const Options& options);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// \throws std::invalid_argument if the drawing's size is not 1 to 32768 pixels each way;
  /// RendererError.
  Image render(const Drawing& drawing);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace traverse::render
