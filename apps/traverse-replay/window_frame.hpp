#pragma once

#include <nanogui/window.h>

namespace traverse::app {

/// A part of the screen that stays where it is put.
class WindowFrame : public nanogui::Window {
 public:
  explicit WindowFrame(nanogui::Widget* parent) : nanogui::Window(parent, "") {}

  bool mouseDragEvent(const nanogui::Vector2i&, const nanogui::Vector2i&, int, int) override {
    return false;
  }
  void draw(NVGcontext* context) override;
};

}  // namespace traverse::app
