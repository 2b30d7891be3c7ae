#include "gl/point_target.hpp"

#include <array>

#include "gl/framebuffer.hpp"

namespace traverse::render::gl {

namespace {

void allocate(const Functions& gl, GLuint texture, GLint internal_format, GLenum format,
              GLenum type, int width, int height) {
  gl.BindTexture(GL_TEXTURE_2D, texture);
  gl.TexImage2D(GL_TEXTURE_2D, 0, internal_format, width, height, 0, format, type, nullptr);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

}  // namespace

PointTarget::PointTarget(const Functions& gl) : gl_(gl) { gl_.GenFramebuffers(1, &framebuffer_); }

void PointTarget::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  gl_.DeleteTextures(1, &colour_);
  gl_.DeleteTextures(1, &depth_);
  gl_.DeleteRenderbuffers(1, &depth_buffer_);
  width_ = height_ = 0;

  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.GenTextures(1, &colour_);
  allocate(gl_, colour_, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, width, height);
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_, 0);
  gl_.GenTextures(1, &depth_);
  allocate(gl_, depth_, GL_R32F, GL_RED, GL_FLOAT, width, height);
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, depth_, 0);
  gl_.GenRenderbuffers(1, &depth_buffer_);
  gl_.BindRenderbuffer(GL_RENDERBUFFER, depth_buffer_);
  gl_.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width, height);
  gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_buffer_);
  constexpr std::array<GLenum, 2> kBoth{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  gl_.DrawBuffers(2, kBoth.data());
  check_framebuffer(gl_);
  width_ = width;
  height_ = height;
}

void PointTarget::begin() const {
  constexpr std::array<float, 4> kTransparent{0, 0, 0, 0};
  constexpr std::array<float, 4> kFar{1e30F, 0, 0, 0};
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.Viewport(0, 0, width_, height_);
  gl_.ClearBufferfv(GL_COLOR, 0, kTransparent.data());
  gl_.ClearBufferfv(GL_COLOR, 1, kFar.data());
}

void PointTarget::begin_layer() const { gl_.Clear(GL_DEPTH_BUFFER_BIT); }

}  // namespace traverse::render::gl
