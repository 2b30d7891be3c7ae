#include "chart.hpp"

#include <algorithm>
#include <cmath>
#include <nanovg.h>
#include <utility>

#include <fmt/format.h>

#include "traverse/render/theme.hpp"
#include "traverse/statistics/quantile.hpp"

#include "look.hpp"

namespace traverse::app {

namespace {

constexpr float kTextHeight = 16;
constexpr float kFont = 14;
constexpr double kClip = 0.97;  // larger values than this share leave the chart at its top

/// The value below which `share` of the finite values lie; 0 if there is none.
float finite_quantile(std::vector<float> values, double share) {
  std::erase_if(values, [](float value) { return !std::isfinite(value); });
  return values.empty() ? 0 : static_cast<float>(statistics::quantile(values, share));
}

/// The next of 1, 2, 5, 10, ... at or above.
float round_up(float value) {
  if (!(value > 0)) return 1;
  const float decade = std::pow(10.0F, std::floor(std::log10(value)));
  for (const float step : {1.0F, 2.0F, 5.0F, 10.0F}) {
    if (value <= step * decade) return step * decade;
  }
  return 10 * decade;
}

void text(NVGcontext* context, float x, float y, int align, NVGcolor colour, const std::string& s) {
  nvgFontFace(context, "sans");
  nvgFontSize(context, kFont);
  nvgTextAlign(context, align | NVG_ALIGN_TOP);
  nvgFillColor(context, colour);
  nvgText(context, x, y, s.c_str(), nullptr);
}

}  // namespace

Chart::Chart(nanogui::Widget* parent, std::string title, std::string unit, render::Colour colour)
    : nanogui::Widget(parent), title_(std::move(title)), unit_(std::move(unit)), colour_(colour) {}

void Chart::set(std::vector<float> values, std::size_t present) {
  values_ = std::move(values);
  present_ = present;
}

void Chart::draw(NVGcontext* context) {
  const render::Theme dark = render::dark_theme();
  const auto x0 = static_cast<float>(mPos.x());
  const auto y0 = static_cast<float>(mPos.y());
  const auto width = static_cast<float>(mSize.x());
  const float top = y0 + kTextHeight + 2;
  const float height = static_cast<float>(mSize.y()) - kTextHeight - 4;

  const float scale = round_up(finite_quantile(values_, kClip));
  const bool has_now = present_ < values_.size() && std::isfinite(values_[present_]);
  text(context, x0, y0, NVG_ALIGN_LEFT, to_nanovg(colour_),
       has_now ? fmt::format("{} {:.3g} {}", title_, values_[present_], unit_)
               : fmt::format("{}: {}", title_, reason_));
  text(context, x0 + width, y0, NVG_ALIGN_RIGHT, to_nanovg(dark.muted),
       fmt::format("0 .. {:g} {}", scale, unit_));

  nvgBeginPath(context);
  nvgRect(context, x0, top, width, height);
  nvgFillColor(context, to_nanovg(dark.background));
  nvgFill(context);
  if (values_.size() < 2) return;

  const auto x_of = [&](std::size_t i) {
    return x0 + width * static_cast<float>(i) / static_cast<float>(values_.size() - 1);
  };
  nvgBeginPath(context);
  bool pen_is_down = false;
  for (std::size_t i = 0; i < values_.size(); ++i) {
    if (!std::isfinite(values_[i])) {
      pen_is_down = false;
      continue;
    }
    const float y = top + height * (1 - std::min(1.0F, values_[i] / scale));
    pen_is_down ? nvgLineTo(context, x_of(i), y) : nvgMoveTo(context, x_of(i), y);
    pen_is_down = true;
  }
  nvgStrokeColor(context, to_nanovg(colour_));
  nvgStrokeWidth(context, 1.5F);
  nvgStroke(context);

  nvgBeginPath(context);
  nvgRect(context, x_of(std::min(present_, values_.size() - 1)) - 0.5F, top, 1, height);
  nvgFillColor(context, to_nanovg(dark.text, 0.6F));
  nvgFill(context);
}

}  // namespace traverse::app
