#include "gl/point_pass.hpp"

#include <cstddef>

#include <Eigen/Core>

#include "gl/program.hpp"

namespace traverse::render::gl {

namespace {

static_assert(sizeof(ScenePoint) == 16, "the points are uploaded as they lie in memory");

constexpr const char* kPointVertexShader = R"(#version 330 core
layout(location = 0) in vec3 p_scene;
layout(location = 1) in vec3 colour;
uniform mat4 clip_from_scene;
uniform vec4 viewport_to_clip;  // factor, offset: the camera's view is only a part of the tile
uniform vec4 depth_from_scene;
out vec3 point_colour;
out float point_depth;
void main() {
  vec4 clip = clip_from_scene * vec4(p_scene, 1.0);
  gl_Position = vec4(clip.xy * viewport_to_clip.xy + viewport_to_clip.zw * clip.w, clip.zw);
  point_colour = colour;
  point_depth = dot(depth_from_scene, vec4(p_scene, 1.0));
}
)";

constexpr const char* kPointFragmentShader = R"(#version 330 core
in vec3 point_colour;
in float point_depth;
uniform bool round_splat;
layout(location = 0) out vec4 colour;
layout(location = 1) out float depth;
void main() {
  vec2 from_centre = 2.0 * gl_PointCoord - 1.0;
  if (round_splat && dot(from_centre, from_centre) > 1.0) discard;
  colour = vec4(point_colour, 1.0);
  depth = point_depth;
}
)";

constexpr const char* kShadeVertexShader = R"(#version 330 core
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(corner, 0.0, 1.0);
}
)";

// Eye-dome lighting: a pixel is darkened by how much nearer its neighbours are, measured as the
// slope towards them. Source: Boucheny, "Visualisation scientifique de grands volumes de donnees",
// PhD thesis, 2009, section 5.2; here with slopes in place of raw depths, so that the effect does
// not depend on the scale of the view, and their logarithm, so that houses do not drown kerbs.
constexpr const char* kShadeFragmentShader = R"(#version 330 core
uniform sampler2D points_colour;
uniform sampler2D points_depth;
uniform float strength;
uniform int radius;             // pixels
uniform vec2 metres_per_pixel;  // at depth 0, and more for each metre of depth
out vec4 colour;
const ivec2 kNeighbours[8] = ivec2[8](ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1),
                                      ivec2(1, 1), ivec2(-1, 1), ivec2(1, -1), ivec2(-1, -1));
void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  vec4 unshaded = texelFetch(points_colour, here, 0);
  if (unshaded.a == 0.0) discard;
  float obscurance = 0.0;
  if (strength > 0.0) {
    ivec2 last = textureSize(points_depth, 0) - 1;
    float depth = texelFetch(points_depth, here, 0).r;
    float step_length = float(radius) * (metres_per_pixel.x + metres_per_pixel.y * depth);
    for (int i = 0; i < 8; ++i) {
      ivec2 there = clamp(here + radius * kNeighbours[i], ivec2(0), last);
      float slope = (depth - texelFetch(points_depth, there, 0).r) / step_length;
      obscurance += log2(1.0 + max(0.0, slope)) / 8.0;
    }
  }
  colour = vec4(unshaded.rgb * exp(-strength * obscurance), 1.0);
}
)";

constexpr int kShadeRadius = 3;  // device pixels

/// OpenGL takes offsets into a buffer as pointers.
const void* offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);  // NOLINT(performance-no-int-to-ptr)
}

}  // namespace

PointPass::PointPass(const Functions& gl)
    : gl_(gl),
      target_(gl),
      point_program_(make_program(gl, kPointVertexShader, kPointFragmentShader)),
      shade_program_(make_program(gl, kShadeVertexShader, kShadeFragmentShader)) {
  point_uniforms_ = {uniform(gl, point_program_, "clip_from_scene"),
                     uniform(gl, point_program_, "viewport_to_clip"),
                     uniform(gl, point_program_, "depth_from_scene"),
                     uniform(gl, point_program_, "round_splat")};
  shade_uniforms_ = {uniform(gl, shade_program_, "strength"), uniform(gl, shade_program_, "radius"),
                     uniform(gl, shade_program_, "metres_per_pixel")};
  gl_.UseProgram(shade_program_);
  gl_.Uniform1i(uniform(gl, shade_program_, "points_colour"), 0);
  gl_.Uniform1i(uniform(gl, shade_program_, "points_depth"), 1);
  gl_.GenVertexArrays(1, &no_vertices_);
}

void PointPass::upload(std::span<const PointCloud* const> clouds) {
  release();  // of a picture that was given up
  for (const PointCloud* cloud : clouds) {
    Cloud uploaded;
    gl_.GenVertexArrays(1, &uploaded.vertex_array);
    gl_.GenBuffers(1, &uploaded.buffer);
    clouds_.push_back(uploaded);
    gl_.BindVertexArray(uploaded.vertex_array);
    gl_.BindBuffer(GL_ARRAY_BUFFER, uploaded.buffer);
    gl_.BufferData(GL_ARRAY_BUFFER,
                   static_cast<GLsizeiptr>(cloud->points.size() * sizeof(ScenePoint)),
                   cloud->points.data(), GL_STATIC_DRAW);
    gl_.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(ScenePoint), offset(0));
    gl_.VertexAttribPointer(1, 3, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(ScenePoint),
                            offset(offsetof(ScenePoint, colour)));
    gl_.EnableVertexAttribArray(0);
    gl_.EnableVertexAttribArray(1);
    check(gl_, "take the points of a picture");
  }
}

void PointPass::release() {
  for (const Cloud& cloud : clouds_) {
    gl_.DeleteVertexArrays(1, &cloud.vertex_array);
    gl_.DeleteBuffers(1, &cloud.buffer);
  }
  clouds_.clear();
}

void PointPass::begin(const Tile& tile) {
  target_.resize(tile.device_width(), tile.device_height());
  gl_.Disable(GL_SCISSOR_TEST);
  target_.begin();
  gl_.Enable(GL_SCISSOR_TEST);
}

void PointPass::draw_points(const Tile& tile, const PointCloud& cloud, std::size_t index) const {
  target_.begin_layer();
  gl_.Disable(GL_BLEND);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthFunc(GL_LESS);
  gl_.UseProgram(point_program_);
  const Eigen::Matrix4f clip_from_scene = cloud.camera.clip_from_scene().cast<float>();
  gl_.UniformMatrix4fv(point_uniforms_.clip_from_scene, 1, GL_FALSE, clip_from_scene.data());
  const Eigen::Vector4f depth = -cloud.camera.T_eye_scene.row(2).transpose().cast<float>();
  gl_.Uniform4f(point_uniforms_.depth_from_scene, depth[0], depth[1], depth[2], depth[3]);
  const Point centre = cloud.viewport.centre();
  gl_.Uniform4f(point_uniforms_.viewport_to_clip,
                static_cast<float>(cloud.viewport.width() / tile.width),
                static_cast<float>(cloud.viewport.height() / tile.height),
                static_cast<float>(2 * (centre.x - tile.left) / tile.width - 1),
                static_cast<float>(2 * (centre.y - tile.top) / tile.height - 1));
  gl_.Uniform1i(point_uniforms_.round_splat, cloud.splat == Splat::kRound ? 1 : 0);
  gl_.PointSize(static_cast<float>(kSupersampling * cloud.diameter));
  gl_.BindVertexArray(clouds_.at(index).vertex_array);
  gl_.DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(cloud.points.size()));
}

void PointPass::draw_shaded(const PointCloud& cloud) const {
  gl_.UseProgram(shade_program_);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Disable(GL_BLEND);
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_2D, target_.colour());
  gl_.ActiveTexture(GL_TEXTURE1);
  gl_.BindTexture(GL_TEXTURE_2D, target_.depth());
  const double per_pixel =
      2 * cloud.camera.half_height / (kSupersampling * cloud.viewport.height());
  gl_.Uniform1f(shade_uniforms_.strength, static_cast<float>(cloud.depth_shading));
  gl_.Uniform1i(shade_uniforms_.radius, kShadeRadius);
  gl_.Uniform2f(shade_uniforms_.metres_per_pixel,
                cloud.camera.perspective ? 0.0F : static_cast<float>(per_pixel),
                cloud.camera.perspective ? static_cast<float>(per_pixel) : 0.0F);
  gl_.BindVertexArray(no_vertices_);
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace traverse::render::gl
