#include "gl/framebuffer.hpp"

#include "traverse/render/renderer.hpp"

namespace traverse::render::gl {

void check_framebuffer(const Functions& gl) {
  check(gl, "allocate the memory of a picture");
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw RendererError("OpenGL does not accept the buffers of a picture");
  }
}

}  // namespace traverse::render::gl
