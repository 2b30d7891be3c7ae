#include "traverse/render/theme.hpp"

namespace traverse::render {

Theme light_theme() {
  Theme theme;
  theme.background = Colour::hex(0xFFFFFF);
  theme.text = Colour::hex(0x1A1C1F);
  theme.muted = Colour::hex(0x5A6068);
  theme.grid = Colour::hex(0xE3E5E8);
  theme.axis = Colour::hex(0xA9AEB5);
  theme.reference = Colour::hex(0x222222);
  theme.other = Colour::hex(0xA9AEB5);
  return theme;
}

Theme dark_theme() {
  Theme theme;
  theme.background = Colour::hex(0x15181D);
  theme.text = Colour::hex(0xE8EAED);
  theme.muted = Colour::hex(0x9AA0A8);
  theme.grid = Colour::hex(0x2C3138);
  theme.axis = Colour::hex(0x5F666F);
  theme.reference = Colour::hex(0xDDDDDD);
  theme.other = Colour::hex(0x6B727B);
  theme.dark = true;
  return theme;
}

}  // namespace traverse::render
