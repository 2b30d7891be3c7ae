#include "gl/shape_pass.hpp"

#include <cstddef>

#include "gl/program.hpp"

namespace traverse::render::gl {

namespace {

constexpr const char* kVertexShader = R"(#version 330 core
layout(location = 0) in vec2 position;
layout(location = 1) in vec4 colour;
uniform vec4 picture_to_clip;  // factor, offset
out vec4 vertex_colour;
void main() {
  gl_Position = vec4(position * picture_to_clip.xy + picture_to_clip.zw, 0.0, 1.0);
  vertex_colour = colour;
}
)";

constexpr const char* kFragmentShader = R"(#version 330 core
in vec4 vertex_colour;
uniform vec4 visible;  // left, top, right, bottom
out vec4 colour;
void main() {
  if (any(lessThan(gl_FragCoord.xy, visible.xy)) || any(greaterThan(gl_FragCoord.xy, visible.zw))) {
    discard;
  }
  colour = vertex_colour;
}
)";

/// OpenGL takes offsets into a buffer as pointers.
const void* buffer_offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);  // NOLINT(performance-no-int-to-ptr)
}

}  // namespace

ShapePass::ShapePass(const Functions& gl)
    : gl_(gl),
      program_(make_program(gl, kVertexShader, kFragmentShader)),
      picture_to_clip_(uniform(gl, program_, "picture_to_clip")),
      visible_(uniform(gl, program_, "visible")) {
  gl_.GenVertexArrays(1, &vertex_array_);
  gl_.GenBuffers(1, &buffer_);
  gl_.BindVertexArray(vertex_array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_);
  gl_.VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, sizeof(ShapeVertex), buffer_offset(0));
  gl_.VertexAttribPointer(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(ShapeVertex),
                          buffer_offset(offsetof(ShapeVertex, red)));
  gl_.EnableVertexAttribArray(0);
  gl_.EnableVertexAttribArray(1);
}

void ShapePass::upload(std::span<const ShapeVertex> vertices) {
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size_bytes()), vertices.data(),
                 GL_STREAM_DRAW);
  check(gl_, "take the lines of a picture");
}

void ShapePass::draw(const Tile& tile, const DeviceRect& clip, std::size_t first,
                     std::size_t count) const {
  gl_.UseProgram(program_);
  // The picture's first row is the framebuffer's first row: what is read back needs no turning.
  const auto width = static_cast<float>(tile.width);
  const auto height = static_cast<float>(tile.height);
  gl_.Uniform4f(picture_to_clip_, 2 / width, 2 / height,
                -2 * static_cast<float>(tile.left) / width - 1,
                -2 * static_cast<float>(tile.top) / height - 1);
  gl_.Uniform4f(visible_, static_cast<float>(clip.left), static_cast<float>(clip.top),
                static_cast<float>(clip.right), static_cast<float>(clip.bottom));
  scissor(gl_, clip);
  gl_.Enable(GL_BLEND);
  gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.BindVertexArray(vertex_array_);
  gl_.DrawArrays(GL_TRIANGLES, static_cast<GLint>(first), static_cast<GLsizei>(count));
}

}  // namespace traverse::render::gl
