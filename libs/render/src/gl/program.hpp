#pragma once

#include "gl/functions.hpp"

namespace traverse::render::gl {

/// Compiles and links. \throws RendererError with the compiler's message.
GLuint make_program(const Functions& gl, const char* vertex_shader, const char* fragment_shader);

/// \throws RendererError if the program has no such uniform in use.
GLint uniform(const Functions& gl, GLuint program, const char* name);

}  // namespace traverse::render::gl
