#pragma once

#include <nanogui/widget.h>

namespace traverse::app {

/// Keys and mouse, over the view.
class HelpOverlay : public nanogui::Widget {
 public:
  explicit HelpOverlay(nanogui::Widget* parent) : nanogui::Widget(parent) {}

  void draw(NVGcontext* context) override;
  nanogui::Vector2i preferredSize(NVGcontext*) const override { return {640, 500}; }
};

}  // namespace traverse::app
