#pragma once

#include <nanogui/widget.h>
#include <utility>
#include <vector>

#include "traverse/render/colour.hpp"

namespace traverse::app {

/// A small field of the colours that something is drawn in.
class Swatch : public nanogui::Widget {
 public:
  Swatch(nanogui::Widget* parent, std::vector<render::Colour> colours)
      : nanogui::Widget(parent), colours_(std::move(colours)) {}

  void draw(NVGcontext* context) override;
  nanogui::Vector2i preferredSize(NVGcontext*) const override { return {16, 20}; }

 private:
  std::vector<render::Colour> colours_;
};

}  // namespace traverse::app
