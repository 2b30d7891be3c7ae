#include "swatch.hpp"

#include <nanovg.h>

#include "look.hpp"

namespace traverse::app {

namespace {

constexpr float kWidth = 14;
constexpr float kHeight = 10;

}  // namespace

void Swatch::draw(NVGcontext* context) {
  const float part = kWidth / static_cast<float>(std::max<std::size_t>(1, colours_.size()));
  const auto x = static_cast<float>(mPos.x());
  const float y = static_cast<float>(mPos.y()) + (static_cast<float>(mSize.y()) - kHeight) / 2;
  for (std::size_t i = 0; i < colours_.size(); ++i) {
    nvgBeginPath(context);
    nvgRect(context, x + part * static_cast<float>(i), y, part, kHeight);
    nvgFillColor(context, to_nanovg(colours_[i]));
    nvgFill(context);
  }
}

}  // namespace traverse::app
