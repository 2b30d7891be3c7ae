#include "gl/shape_target.hpp"

#include "gl/framebuffer.hpp"

namespace traverse::render::gl {

namespace {

constexpr GLsizei kSamples = 4;  // the most that llvmpipe offers

}  // namespace

ShapeTarget::ShapeTarget(const Functions& gl) : gl_(gl) {
  gl_.GenFramebuffers(1, &sampled_);
  gl_.GenFramebuffers(1, &averaged_);
}

void ShapeTarget::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  gl_.DeleteRenderbuffers(1, &sampled_colour_);
  gl_.DeleteRenderbuffers(1, &averaged_colour_);
  width_ = height_ = 0;

  gl_.GenRenderbuffers(1, &sampled_colour_);
  gl_.BindRenderbuffer(GL_RENDERBUFFER, sampled_colour_);
  gl_.RenderbufferStorageMultisample(GL_RENDERBUFFER, kSamples, GL_RGBA8, width, height);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, sampled_);
  gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                              sampled_colour_);
  check_framebuffer(gl_);

  gl_.GenRenderbuffers(1, &averaged_colour_);
  gl_.BindRenderbuffer(GL_RENDERBUFFER, averaged_colour_);
  gl_.RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, averaged_);
  gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                              averaged_colour_);
  check_framebuffer(gl_);
  width_ = width;
  height_ = height;
}

void ShapeTarget::bind() const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, sampled_);
  gl_.Viewport(0, 0, width_, height_);
}

cv::Mat ShapeTarget::read() const {
  gl_.Disable(GL_SCISSOR_TEST);  // it would cut the blit, too
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, sampled_);
  gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, averaged_);
  gl_.BlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, averaged_);
  cv::Mat pixels(height_, width_, CV_8UC4);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_.ReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data);
  check(gl_, "read a picture back");
  return pixels;
}

}  // namespace traverse::render::gl
