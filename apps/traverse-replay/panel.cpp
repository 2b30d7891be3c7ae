#include "panel.hpp"

#include <cmath>
#include <limits>
#include <nanogui/layout.h>
#include <nanogui/screen.h>

#include "traverse/render/palette.hpp"

#include "folding_group.hpp"

namespace traverse::app {

namespace {

constexpr std::size_t kChartFrames = 300;  // around the frame on show

}  // namespace

Panel::Panel(nanogui::Widget* parent, Console& console) : WindowFrame(parent), console_(console) {
  setLayout(new nanogui::BoxLayout(nanogui::Orientation::Vertical, nanogui::Alignment::Fill, 8, 6));
  setFixedWidth(kWidth);
  view_ = new ViewGroup(this, console);
  health_ = new HealthGroup(this, console);
  charts_ = new FoldingGroup(this, "Error and time", true);
  error_ = new Chart(charts_->content(), "error", "m", render::palette::kSkyBlue);
  error_->setTooltip("Distance to the reference, aligned at the first frame; 300 frames around");
  if (!console.player().recording().reference()) error_->set_reason("no reference");
  time_ = new Chart(charts_->content(), "estimator", "ms", render::palette::kOrange);
  time_->setTooltip("Wall time of the estimator for each frame; 300 frames around");
  estimator_ = new EstimatorGroup(this, console);
}

void Panel::fold_to_fit(int height) {
  for (FoldingGroup* group : {charts_, static_cast<FoldingGroup*>(health_)}) {
    if (preferredSize(screen()->nvgContext()).y() <= height) return;
    group->set_open(false);
  }
}

void Panel::refresh(const replay::ColourLegend& legend) {
  view_->refresh(legend);
  health_->refresh();
  estimator_->refresh();
  refresh_charts();
}

void Panel::refresh_charts() {
  const replay::PlayerStatus status = console_.player().status();
  if (status.generation != generation_) {
    generation_ = status.generation;
    errors_.clear();
    milliseconds_.clear();
  }
  for (const replay::PastFrame& frame : console_.player().past(errors_.size())) {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    errors_.push_back(static_cast<float>(frame.error_m.value_or(unknown)));
    milliseconds_.push_back(static_cast<float>(frame.pose.milliseconds));
  }
  const std::size_t shown = status.shown.value_or(status.origin);
  const std::size_t present = shown >= status.origin ? shown - status.origin : 0;
  const std::size_t begin = present > kChartFrames / 2 ? present - kChartFrames / 2 : 0;
  const std::size_t end = std::min(errors_.size(), begin + kChartFrames);
  const auto window = [&](const std::vector<float>& values) {
    return std::vector<float>(values.begin() + static_cast<std::ptrdiff_t>(std::min(begin, end)),
                              values.begin() + static_cast<std::ptrdiff_t>(end));
  };
  error_->set(window(errors_), present - begin);
  time_->set(window(milliseconds_), present - begin);
}

}  // namespace traverse::app
