#pragma once

#include "gl/functions.hpp"

namespace traverse::render::gl {

/// \throws RendererError if the bound framebuffer cannot be drawn to, or its memory is not there.
void check_framebuffer(const Functions& gl);

}  // namespace traverse::render::gl
