#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "gl/functions.hpp"

namespace traverse::render::gl {

/// An OSMesa context (OpenGL 3.3 core). Its objects live until it is destroyed.
class Context {
 public:
  /// \throws RendererError
  Context();
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Does `work` with the context current and waits for it, in a thread of its own: making it
  /// current in the caller's thread would take the place of a context of another library there,
  /// which that library would not notice. Passes on what `work` throws.
  void run(const std::function<void()>& work);

 private:
  static constexpr std::size_t kBufferSide = 4;

  OSMesaContext context_ = nullptr;
  // OSMesa wants a buffer to be current with; all drawing goes to framebuffer objects.
  std::array<std::uint8_t, 4 * kBufferSide * kBufferSide> buffer_{};
};

}  // namespace traverse::render::gl
