#pragma once

#include <nanogui/widget.h>
#include <string>
#include <utility>
#include <vector>

#include "traverse/render/colour.hpp"

namespace traverse::app {

/// A line of values by frame, with its newest value, its largest and where the frame on show is.
class Chart : public nanogui::Widget {
 public:
  Chart(nanogui::Widget* parent, std::string title, std::string unit, render::Colour colour);

  /// Why there may be no value at all: "no reference".
  void set_reason(std::string reason) { reason_ = std::move(reason); }

  /// \param values one a frame, NaN where there is none  \param present place of the frame on show
  void set(std::vector<float> values, std::size_t present);

  void draw(NVGcontext* context) override;
  nanogui::Vector2i preferredSize(NVGcontext*) const override { return {260, 58}; }

 private:
  std::string title_;
  std::string unit_;
  std::string reason_ = "not known";
  render::Colour colour_;
  std::vector<float> values_;
  std::size_t present_ = 0;
};

}  // namespace traverse::app
