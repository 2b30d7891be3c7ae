#include <array>
#include <cstdint>

#include <GL/osmesa.h>
#include <gtest/gtest.h>

#include "traverse/render/renderer.hpp"

#include "render/sample_drawing.hpp"

namespace traverse::render {
namespace {

TEST(Renderer, LeavesAnotherLibrarysContextCurrent) {
  const OSMesaContext other = OSMesaCreateContext(OSMESA_RGBA, nullptr);
  ASSERT_NE(other, nullptr);
  std::array<std::uint8_t, 256> buffer{};  // 8 x 8 pixels
  ASSERT_EQ(OSMesaMakeCurrent(other, buffer.data(), GL_UNSIGNED_BYTE, 8, 8), GL_TRUE);
  {
    Renderer renderer;
    EXPECT_EQ(OSMesaGetCurrentContext(), other);
    renderer.render(sample_drawing(200, 100));
    EXPECT_EQ(OSMesaGetCurrentContext(), other);
  }
  EXPECT_EQ(OSMesaGetCurrentContext(), other);
  OSMesaMakeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0);
  OSMesaDestroyContext(other);
}

}  // namespace
}  // namespace traverse::render
