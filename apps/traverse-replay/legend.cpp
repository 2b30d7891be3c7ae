#include "legend.hpp"

#include <nanovg.h>
#include <string>

#include "traverse/render/theme.hpp"

#include "look.hpp"

namespace traverse::app {

namespace {

constexpr float kTitle = 17;
constexpr float kStrip = 8;
constexpr float kFont = 13;

}  // namespace

void Legend::draw(NVGcontext* context) {
  const auto x = static_cast<float>(mPos.x());
  const auto y = static_cast<float>(mPos.y());
  const auto width = static_cast<float>(mSize.x());
  nvgFontFace(context, "sans");
  nvgFontSize(context, kFont);
  nvgFillColor(context, to_nanovg(render::dark_theme().muted));
  const auto write = [&](float at, float line, int align, const std::string& text) {
    nvgTextAlign(context, align | NVG_ALIGN_TOP);
    nvgText(context, at, line, text.c_str(), nullptr);
  };
  write(x, y, NVG_ALIGN_LEFT, legend_.title);
  const float below = y + kTitle + kStrip + 4;
  const std::size_t samples = legend_.samples.size();
  const float part = width / static_cast<float>(std::max<std::size_t>(1, samples));
  if (legend_.labels.size() == samples) {
    for (std::size_t i = 0; i < samples; ++i) {
      const float middle = x + part * (static_cast<float>(i) + 0.5F);
      write(middle, below, NVG_ALIGN_CENTER, legend_.labels[i]);
    }
  } else if (!legend_.labels.empty()) {
    write(x, below, NVG_ALIGN_LEFT, legend_.labels.front());
    write(x + width, below, NVG_ALIGN_RIGHT, legend_.labels.back());
  }
  for (std::size_t i = 0; i < samples; ++i) {
    nvgBeginPath(context);
    nvgRect(context, x + part * static_cast<float>(i), y + kTitle, part + 0.5F, kStrip);
    nvgFillColor(context, to_nanovg(legend_.samples[i]));
    nvgFill(context);
  }
}

}  // namespace traverse::app
