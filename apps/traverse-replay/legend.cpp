#include "legend.hpp"

#include <nanovg.h>
#include <utility>

#include "traverse/render/theme.hpp"

#include "look.hpp"

namespace traverse::app {

namespace {

constexpr float kStrip = 8;
constexpr float kFont = 13;

}  // namespace

void Legend::set(std::string text, std::vector<render::Colour> samples) {
  text_ = std::move(text);
  samples_ = std::move(samples);
}

void Legend::draw(NVGcontext* context) {
  const auto x = static_cast<float>(mPos.x());
  const auto y = static_cast<float>(mPos.y());
  const float all = static_cast<float>(mSize.x());
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const float part = all / static_cast<float>(samples_.size());
    nvgBeginPath(context);
    nvgRect(context, x + part * static_cast<float>(i), y, part + 0.5F, kStrip);
    nvgFillColor(context, to_nanovg(samples_[i]));
    nvgFill(context);
  }
  nvgFontFace(context, "sans");
  nvgFontSize(context, kFont);
  nvgTextAlign(context, NVG_ALIGN_LEFT | NVG_ALIGN_TOP);
  nvgFillColor(context, to_nanovg(render::dark_theme().muted));
  nvgText(context, x, y + kStrip + 4, text_.c_str(), nullptr);
}

}  // namespace traverse::app
