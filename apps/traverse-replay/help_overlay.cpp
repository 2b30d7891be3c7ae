#include "help_overlay.hpp"

#include <array>
#include <nanovg.h>
#include <utility>

#include "traverse/render/theme.hpp"

#include "look.hpp"

namespace traverse::app {

namespace {

constexpr std::array<std::pair<const char*, const char*>, 20> kKeys{{
    {"space", "play, pause"},
    {"left, right", "one frame back, on"},
    {"shift + left, right", "ten frames back, on"},
    {"home, end", "first frame, last frame"},
    {"[  ]", "half, twice the speed"},
    {"M", "as fast as the estimator can"},
    {"L", "loop"},
    {"I  O  P", "play range begins, ends here; none"},
    {"G", "go to a frame, time or stamp"},
    {"F  T  V", "follow, top, free view"},
    {"C", "next colouring of the scan"},
    {"1 .. 7", "scan, map, local map, matches, estimate, reference, grid"},
    {"R", "restart the estimator here (shift: from the start)"},
    {"S", "screenshot"},
    {"ctrl + S", "save trajectory and map"},
    {"H", "this help"},
    {"Q", "quit"},
    {"left mouse", "turn the view (shift: move along the ground)"},
    {"right mouse", "move the view"},
    {"wheel", "zoom"},
}};
constexpr float kLine = 22;
constexpr float kPadding = 20;
constexpr float kColumn = 180;
constexpr float kWidth = 620;

}  // namespace

void HelpOverlay::draw(NVGcontext* context) {
  const render::Theme dark = render::dark_theme();
  const float height = 2 * kPadding + kLine * static_cast<float>(kKeys.size());
  const auto x = static_cast<float>(mPos.x());
  const auto y = static_cast<float>(mPos.y());
  nvgBeginPath(context);
  nvgRoundedRect(context, x, y, kWidth, height, 6);
  nvgFillColor(context, to_nanovg(dark.background, 0.92F));
  nvgFill(context);
  nvgStrokeColor(context, to_nanovg(dark.axis));
  nvgStroke(context);
  nvgFontSize(context, 16);
  nvgTextAlign(context, NVG_ALIGN_LEFT | NVG_ALIGN_TOP);
  float line = y + kPadding;
  for (const auto& [key, meaning] : kKeys) {
    nvgFontFace(context, "sans-bold");
    nvgFillColor(context, to_nanovg(dark.text));
    nvgText(context, x + kPadding, line, key, nullptr);
    nvgFontFace(context, "sans");
    nvgFillColor(context, to_nanovg(dark.muted));
    nvgText(context, x + kPadding + kColumn, line, meaning, nullptr);
    line += kLine;
  }
}

}  // namespace traverse::app
