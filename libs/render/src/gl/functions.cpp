#include "gl/functions.hpp"

#include <string>

#include <fmt/format.h>

#include "traverse/render/renderer.hpp"

namespace traverse::render::gl {

Functions Functions::load() {
  Functions functions;
  const auto find = [](const char* name) {
    const OSMESAproc address = OSMesaGetProcAddress(name);
    if (address == nullptr) throw RendererError(fmt::format("OSMesa has no function {}", name));
    return address;
  };
#define TRAVERSE_GL_LOAD(name) \
  functions.name = reinterpret_cast<decltype(functions.name)>(find("gl" #name));
  TRAVERSE_GL_FUNCTIONS(TRAVERSE_GL_LOAD)
#undef TRAVERSE_GL_LOAD
  return functions;
}

void check(const Functions& gl, const char* doing) {
  const GLenum error = gl.GetError();
  if (error == GL_NO_ERROR) return;
  const std::string reason =
      error == GL_OUT_OF_MEMORY ? "out of memory" : fmt::format("0x{:04x}", error);
  throw RendererError(fmt::format("OpenGL refuses to {}: {}", doing, reason));
}

}  // namespace traverse::render::gl
