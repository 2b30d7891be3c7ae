#pragma once

#include <nanogui/widget.h>
#include <string>
#include <vector>

#include "traverse/render/colour.hpp"

namespace traverse::app {

/// What colours mean: a strip of them with the words below.
class Legend : public nanogui::Widget {
 public:
  explicit Legend(nanogui::Widget* parent) : nanogui::Widget(parent) {}

  void set(std::string text, std::vector<render::Colour> samples);

  void draw(NVGcontext* context) override;
  nanogui::Vector2i preferredSize(NVGcontext*) const override { return {270, 30}; }

 private:
  std::string text_;
  std::vector<render::Colour> samples_;
};

}  // namespace traverse::app
