#include "gl/context.hpp"

#include <future>

#include "traverse/render/renderer.hpp"

namespace traverse::render::gl {

namespace {

void in_own_thread(const std::function<void()>& work) {
  std::async(std::launch::async, work).get();
}

/// Makes a context current in this thread for as long as it lives.
class Current {
 public:
  Current(OSMesaContext context, void* buffer, int side) {
    if (OSMesaMakeCurrent(context, buffer, GL_UNSIGNED_BYTE, side, side) != GL_TRUE) {
      throw RendererError("the OSMesa context cannot be made current");
    }
  }
  ~Current() { OSMesaMakeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }
  Current(const Current&) = delete;
  Current& operator=(const Current&) = delete;
};

constexpr std::array<int, 11> kWanted{OSMESA_FORMAT,
                                      OSMESA_RGBA,
                                      OSMESA_DEPTH_BITS,
                                      0,
                                      OSMESA_PROFILE,
                                      OSMESA_CORE_PROFILE,
                                      OSMESA_CONTEXT_MAJOR_VERSION,
                                      3,
                                      OSMESA_CONTEXT_MINOR_VERSION,
                                      3,
                                      0};

}  // namespace

Context::Context() {
  in_own_thread([this] { context_ = OSMesaCreateContextAttribs(kWanted.data(), nullptr); });
  if (context_ == nullptr) throw RendererError("OSMesa offers no OpenGL 3.3 core context");
}

Context::~Context() {
  in_own_thread([this] { OSMesaDestroyContext(context_); });
}

void Context::run(const std::function<void()>& work) {
  in_own_thread([&] {
    const Current current(context_, buffer_.data(), int{kBufferSide});
    work();
  });
}

}  // namespace traverse::render::gl
