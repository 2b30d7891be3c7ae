#pragma once

#include <vector>

#include "traverse/render/palette.hpp"
#include "traverse/render/theme.hpp"

#include "view_settings.hpp"

namespace traverse::app {

// The map recedes behind the scan: a ramp of blue greys by height.
inline constexpr render::Colour kLowMapColour = render::Colour::hex(0x4A5563);
inline constexpr render::Colour kHighMapColour = render::Colour::hex(0xB4C6D8);
inline constexpr render::Colour kLocalMapColour = render::palette::kPurple;
inline constexpr render::Colour kLineMatchColour = render::palette::kOrange;
inline constexpr render::Colour kPlaneMatchColour = render::palette::kGreen;
inline constexpr render::Colour kEstimateColour = render::palette::kSkyBlue;
inline constexpr render::Colour kBeyondColour = render::Colour::hex(0x2F5168);  // receding

/// The colours that a layer is drawn in; none for the scan, which has a legend.
inline std::vector<render::Colour> colours_of(Layer layer) {
  switch (layer) {
    case Layer::kScan:
      return {};
    case Layer::kMap:
      return {kLowMapColour, kHighMapColour};
    case Layer::kLocalMap:
      return {kLocalMapColour};
    case Layer::kMatches:
      return {kLineMatchColour, kPlaneMatchColour};
    case Layer::kEstimate:
      return {kEstimateColour};
    case Layer::kReference:
      return {render::dark_theme().reference};
    case Layer::kGrid:
      return {render::dark_theme().axis};
  }
  return {};
}

}  // namespace traverse::app
