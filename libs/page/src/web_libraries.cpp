#include "web_libraries.hpp"

// The assembler takes the files in as they are; `name` and `name_end` stand around their bytes.
#define TRAVERSE_EMBED(name, file)                                                              \
  __asm__(".section .rodata\n.global traverse_" #name "\ntraverse_" #name ":\n.incbin \"" file  \
          "\"\n.global traverse_" #name "_end\ntraverse_" #name "_end:\n.byte 0\n.previous\n"); \
  extern "C" const char traverse_##name[];                                                      \
  extern "C" const char traverse_##name##_end[]

TRAVERSE_EMBED(three, TRAVERSE_THREE_JS);
TRAVERSE_EMBED(orbit_controls, TRAVERSE_ORBIT_CONTROLS_JS);
TRAVERSE_EMBED(dygraphs, TRAVERSE_DYGRAPHS_JS);
TRAVERSE_EMBED(dygraphs_style, TRAVERSE_DYGRAPHS_CSS);

namespace traverse::page::web {

namespace {

std::string_view between(const char* begin, const char* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

}  // namespace

std::string_view three() { return between(traverse_three, traverse_three_end); }
std::string_view orbit_controls() {
  return between(traverse_orbit_controls, traverse_orbit_controls_end);
}
std::string_view dygraphs() { return between(traverse_dygraphs, traverse_dygraphs_end); }
std::string_view dygraphs_style() {
  return between(traverse_dygraphs_style, traverse_dygraphs_style_end);
}

const std::string_view kThreeVersion = TRAVERSE_THREE_JS_VERSION;
const std::string_view kDygraphsVersion = TRAVERSE_DYGRAPHS_JS_VERSION;

}  // namespace traverse::page::web
