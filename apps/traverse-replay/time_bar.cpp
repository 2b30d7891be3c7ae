#include "time_bar.hpp"

#include <algorithm>
#include <cmath>
#include <nanovg.h>

#include "traverse/render/colour_map.hpp"
#include "traverse/render/palette.hpp"
#include "traverse/render/theme.hpp"

#include "look.hpp"

namespace traverse::app {

namespace {

constexpr int kMargin = 12;
constexpr float kBarTop = 9;
constexpr float kBarHeight = 16;
constexpr float kMarkSize = 4;
constexpr float kSeam = 0.5F;  // stripes overlap, or smoothed edges would show between them

void fill_rect(NVGcontext* context, float x0, float x1, float y, float height, NVGcolor colour) {
  nvgBeginPath(context);
  nvgRect(context, x0, y, std::max(1.0F, x1 - x0 + kSeam), height);
  nvgFillColor(context, colour);
  nvgFill(context);
}

}  // namespace

TimeBar::TimeBar(nanogui::Widget* parent, Console& console)
    : nanogui::Widget(parent), console_(console) {
  setTooltip(
      "Click or drag to seek. Colours: error of the frames estimated so far (dark small, "
      "yellow large). Orange marks: skipped records. Red: frames not registered");
}

void TimeBar::refresh() {
  status_ = console_.player().status();
  skipped_ = console_.player().skipped();
  if (status_.generation != generation_) {
    generation_ = status_.generation;
    errors_.clear();
    registered_.clear();
  }
  const std::vector<std::string> columns = console_.player().columns();
  const auto column = static_cast<std::size_t>(
      std::find(columns.begin(), columns.end(), "registered") - columns.begin());
  for (const replay::PastFrame& frame : console_.player().past(errors_.size())) {
    errors_.push_back(frame.error_m.value_or(-1));
    const bool first = registered_.empty();
    registered_.push_back(first || column >= frame.pose.record.size() ||
                          frame.pose.record[column] != 0);
  }
}

float TimeBar::x_of(double frame) const {
  const double last = std::max<double>(1, static_cast<double>(status_.frames) - 1);
  const double width = mSize.x() - 2 * kMargin;
  return static_cast<float>(mPos.x() + kMargin + width * std::clamp(frame / last, 0.0, 1.0));
}

void TimeBar::seek_to(int x) {
  const double share =
      static_cast<double>(x - mPos.x() - kMargin) / std::max(1, mSize.x() - 2 * kMargin);
  const double last = static_cast<double>(std::max<std::size_t>(status_.frames, 1) - 1);
  const auto frame = static_cast<std::size_t>(std::lround(std::clamp(share, 0.0, 1.0) * last));
  console_.player().control([&](replay::Controls& controls) { controls.seek(frame); });
}

bool TimeBar::mouseButtonEvent(const nanogui::Vector2i& p, int button, bool down, int) {
  if (button == 0 && down) seek_to(p.x());
  return true;
}

bool TimeBar::mouseDragEvent(const nanogui::Vector2i& p, const nanogui::Vector2i&, int, int) {
  seek_to(p.x());
  return true;
}

void TimeBar::draw(NVGcontext* context) {
  const render::Theme dark = render::dark_theme();
  const float top = static_cast<float>(mPos.y()) + kBarTop;
  const float left = x_of(0);
  const float right = static_cast<float>(mPos.x() + mSize.x() - kMargin);
  fill_rect(context, left, right, top, kBarHeight, to_nanovg(dark.grid));
  draw_estimated(context, top, kBarHeight);
  if (!status_.frames_complete) {  // how far the index has come
    const float end = left + (right - left) * static_cast<float>(status_.index_share);
    fill_rect(context, left, end, top + kBarHeight + 2, 2, to_nanovg(render::palette::kSkyBlue));
  }
  if (status_.range_first || status_.range_last) {
    const double last = static_cast<double>(status_.frames);
    const float a = x_of(static_cast<double>(status_.range_first.value_or(0)));
    const float b = x_of(status_.range_last ? static_cast<double>(*status_.range_last) : last);
    fill_rect(context, a, b, top - 4, 2, to_nanovg(dark.text));
  }
  draw_marks(context, top, kBarHeight);
  const float x = x_of(static_cast<double>(status_.shown.value_or(0)));
  fill_rect(context, x - 1.5F, x + 1.5F, top - 4, kBarHeight + 8, to_nanovg(dark.text));
  if (status_.busy) {  // on the way there
    const float wanted = x_of(static_cast<double>(status_.wanted));
    fill_rect(context, wanted - 0.5F, wanted + 0.5F, top - 4, kBarHeight + 8,
              to_nanovg(render::palette::kSkyBlue));
  }
}

/// One stripe a pixel: the largest error of the frames in it.
void TimeBar::draw_estimated(NVGcontext* context, float top, float height) const {
  const double most = errors_.empty() ? 0 : *std::max_element(errors_.begin(), errors_.end());
  for (std::size_t i = 0; i < errors_.size();) {
    const float x = x_of(static_cast<double>(status_.origin + i));
    double error = errors_[i];
    std::size_t j = i + 1;
    for (; j < errors_.size() && x_of(static_cast<double>(status_.origin + j)) - x < 1; ++j) {
      error = std::max(error, errors_[j]);
    }
    const float end = x_of(static_cast<double>(status_.origin + j));
    const render::Colour colour =
        error < 0 || most <= 0
            ? render::palette::kBlue
            : render::colour_at(render::ColourMap::kViridis, 0.15 + 0.85 * error / most);
    fill_rect(context, x, end, top, height, to_nanovg(colour));
    i = j;
  }
}

void TimeBar::draw_marks(NVGcontext* context, float top, float height) const {
  for (std::size_t i = 0; i < registered_.size(); ++i) {
    if (registered_[i]) continue;
    const float x = x_of(static_cast<double>(status_.origin + i));
    fill_rect(context, x - 1, x + 1, top, height, nvgRGB(220, 50, 47));
  }
  for (const auto& skipped : skipped_) {
    const float x = x_of(static_cast<double>(skipped.first_behind_frames));
    nvgBeginPath(context);
    nvgMoveTo(context, x - kMarkSize, top - 6);
    nvgLineTo(context, x + kMarkSize, top - 6);
    nvgLineTo(context, x, top);
    nvgFillColor(context, to_nanovg(render::palette::kOrange));
    nvgFill(context);
  }
}

}  // namespace traverse::app
