#include "window_frame.hpp"

#include <nanogui/theme.h>
#include <nanovg.h>

namespace traverse::app {

/// Flat, where nanogui would draw a shadow and a round border.
void WindowFrame::draw(NVGcontext* context) {
  nvgBeginPath(context);
  nvgRect(context, static_cast<float>(mPos.x()), static_cast<float>(mPos.y()),
          static_cast<float>(mSize.x()), static_cast<float>(mSize.y()));
  const nanogui::Color& fill = mTheme->mWindowFillUnfocused;
  nvgFillColor(context, nvgRGBAf(fill.r(), fill.g(), fill.b(), fill.w()));
  nvgFill(context);
  nanogui::Widget::draw(context);
}

}  // namespace traverse::app
