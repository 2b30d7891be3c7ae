#pragma once

// The prototypes serve for the types of the pointers only: nothing here links to a gl* symbol.
#ifndef GL_GLEXT_PROTOTYPES
#define GL_GLEXT_PROTOTYPES
#endif
#include <GL/osmesa.h>

namespace traverse::render::gl {

// clang-format off
#define TRAVERSE_GL_FUNCTIONS(F)                                                               \
  F(ActiveTexture) F(AttachShader) F(BindBuffer) F(BindFramebuffer) F(BindRenderbuffer)        \
  F(BindTexture) F(BindVertexArray) F(BlendFuncSeparate) F(BlitFramebuffer) F(BufferData)      \
  F(CheckFramebufferStatus) F(Clear) F(ClearBufferfv) F(ClearColor) F(CompileShader)           \
  F(CreateProgram) F(CreateShader) F(DeleteBuffers) F(DeleteFramebuffers)                      \
  F(DeleteRenderbuffers) F(DeleteShader) F(DeleteTextures) F(DeleteVertexArrays) F(DepthFunc) F(Disable)             \
  F(DrawArrays) F(DrawBuffers) F(Enable) F(EnableVertexAttribArray) F(FramebufferRenderbuffer) \
  F(FramebufferTexture2D) F(GenBuffers) F(GenFramebuffers) F(GenRenderbuffers) F(GenTextures)  \
  F(GenVertexArrays) F(GetError) F(GetProgramInfoLog) F(GetProgramiv) F(GetShaderInfoLog)      \
  F(GetShaderiv) F(GetUniformLocation) F(LinkProgram) F(PixelStorei) F(PointSize)              \
  F(ReadPixels) F(RenderbufferStorage) F(RenderbufferStorageMultisample) F(Scissor)            \
  F(ShaderSource) F(TexImage2D) F(TexParameteri) F(Uniform1f) F(Uniform1i) F(Uniform2f)        \
  F(Uniform4f) F(UniformMatrix4fv) F(UseProgram) F(VertexAttribPointer) F(Viewport)
// clang-format on

/// The OpenGL functions of OSMesa, asked for by name. Calling linked gl* symbols instead would
/// reach whatever OpenGL another library brought into the process.
struct Functions {
#define TRAVERSE_GL_MEMBER(name) \
  decltype(&::gl##name) name = nullptr;  // NOLINT(bugprone-macro-parentheses)
  TRAVERSE_GL_FUNCTIONS(TRAVERSE_GL_MEMBER)
#undef TRAVERSE_GL_MEMBER

  /// With a context current. \throws RendererError naming a function that is missing.
  static Functions load();
};

/// \throws RendererError if OpenGL noted an error since the last call; `doing` says what was done.
void check(const Functions& gl, const char* doing);

}  // namespace traverse::render::gl
