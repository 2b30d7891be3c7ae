#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "traverse/replay/scan_colours.hpp"

namespace traverse::app {

/// What can be shown or hidden.
enum class Layer { kScan, kMap, kLocalMap, kMatches, kEstimate, kReference, kGrid };
inline constexpr std::array<std::string_view, 7> kLayerNames{
    "scan", "map", "local-map", "matches", "estimate", "reference", "grid"};

enum class CameraMode { kFollow, kTop, kFree };
inline constexpr std::array<std::string_view, 3> kCameraNames{"follow", "top", "free"};

/// How the view looks.
struct ViewSettings {
  replay::ScanColour colour = replay::ScanColour::kClass;
  CameraMode camera = CameraMode::kFollow;
  std::array<bool, kLayerNames.size()> layers{true, true, false, true, true, true, true};
  bool help = false;

  bool& shows(Layer layer) { return layers[static_cast<std::size_t>(layer)]; }
  bool shows(Layer layer) const { return layers[static_cast<std::size_t>(layer)]; }
};

}  // namespace traverse::app
