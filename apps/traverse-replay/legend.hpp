#pragma once

#include <nanogui/widget.h>

#include "traverse/replay/scan_colours.hpp"

namespace traverse::app {

/// What colours mean: a title, a strip of them and labels below it.
class Legend : public nanogui::Widget {
 public:
  explicit Legend(nanogui::Widget* parent) : nanogui::Widget(parent) {}

  void set(const replay::ColourLegend& legend) { legend_ = legend; }

  void draw(NVGcontext* context) override;
  nanogui::Vector2i preferredSize(NVGcontext*) const override { return {270, 46}; }

 private:
  replay::ColourLegend legend_;
};

}  // namespace traverse::app
