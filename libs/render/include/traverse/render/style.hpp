#pragma once

#include "traverse/render/theme.hpp"

namespace traverse::render {

/// How a picture looks, whatever it shows.
struct Style {
  int width = 1600;   ///< pixels
  int height = 1000;  ///< pixels
  Theme theme = light_theme();
};

}  // namespace traverse::render
