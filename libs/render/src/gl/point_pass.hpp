#pragma once

#include <span>
#include <vector>

#include "traverse/render/drawing.hpp"

#include "gl/functions.hpp"
#include "gl/point_target.hpp"
#include "gl/tile.hpp"

namespace traverse::render::gl {

/// Draws point clouds: first by themselves, nearest in front, then shaded into the picture. With
/// the context current throughout.
class PointPass {
 public:
  explicit PointPass(const Functions& gl);

  /// By how much tiles must overlap so that points and shading do not end at their borders, pixels
  /// of the picture.
  static constexpr int kTileMargin = 16;

  /// Uploads the points of `clouds`, which draw() then knows by their place in it.
  void upload(std::span<const PointCloud* const> clouds);

  /// Begins with an empty point target of the tile's size.
  void begin(const Tile& tile);
  /// Draws the tile's part of `cloud`, the `index`-th uploaded, in front of what is in the target.
  void draw_points(const Tile& tile, const PointCloud& cloud, std::size_t index) const;
  /// Draws the point target into what is bound, shaded as `cloud` says.
  void draw_shaded(const PointCloud& cloud) const;

  /// Gives the points' memory back.
  void release();

 private:
  struct Cloud {
    GLuint vertex_array = 0;
    GLuint buffer = 0;
  };
  struct PointUniforms {
    GLint clip_from_scene, viewport_to_clip, depth_from_scene, round_splat;
  };
  struct ShadeUniforms {
    GLint strength, radius, metres_per_pixel;
  };

  const Functions& gl_;
  PointTarget target_;
  GLuint point_program_;
  GLuint shade_program_;
  PointUniforms point_uniforms_{};
  ShadeUniforms shade_uniforms_{};
  GLuint no_vertices_ = 0;  ///< the core profile wants some vertex array bound
  std::vector<Cloud> clouds_;
};

}  // namespace traverse::render::gl
