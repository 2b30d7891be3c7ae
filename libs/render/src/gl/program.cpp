#include "gl/program.hpp"

#include <array>

#include <fmt/format.h>

#include "traverse/render/renderer.hpp"

namespace traverse::render::gl {

namespace {

GLuint compile(const Functions& gl, GLenum stage, const char* source) {
  const GLuint shader = gl.CreateShader(stage);
  gl.ShaderSource(shader, 1, &source, nullptr);
  gl.CompileShader(shader);
  GLint compiled = GL_FALSE;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled != GL_TRUE) {
    std::array<char, 1000> log{};
    gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw RendererError(fmt::format("a shader does not compile: {}", log.data()));
  }
  return shader;
}

}  // namespace

GLuint make_program(const Functions& gl, const char* vertex_shader, const char* fragment_shader) {
  const GLuint program = gl.CreateProgram();
  for (const GLuint shader : {compile(gl, GL_VERTEX_SHADER, vertex_shader),
                              compile(gl, GL_FRAGMENT_SHADER, fragment_shader)}) {
    gl.AttachShader(program, shader);
    gl.DeleteShader(shader);  // goes with the program
  }
  gl.LinkProgram(program);
  GLint linked = GL_FALSE;
  gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked != GL_TRUE) {
    std::array<char, 1000> log{};
    gl.GetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw RendererError(fmt::format("a shader program does not link: {}", log.data()));
  }
  return program;
}

GLint uniform(const Functions& gl, GLuint program, const char* name) {
  const GLint location = gl.GetUniformLocation(program, name);
  if (location < 0) throw RendererError(fmt::format("a shader has no uniform {}", name));
  return location;
}

}  // namespace traverse::render::gl
