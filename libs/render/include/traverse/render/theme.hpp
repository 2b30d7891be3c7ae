#pragma once

#include "traverse/render/colour.hpp"

namespace traverse::render {

/// Everything of a picture that is not data. Text keeps a contrast of 4.5:1 against the background.
struct Theme {
  Colour background;
  Colour text;       ///< title, statistic, values
  Colour muted;      ///< axis labels, ticks, provenance
  Colour grid;       ///< few, light lines
  Colour axis;       ///< the zero line and other lines to read against
  Colour reference;  ///< the dashed neutral trajectory
  Colour other;      ///< data without a class of its own
  bool dark = false;
};

Theme light_theme();
Theme dark_theme();

}  // namespace traverse::render
