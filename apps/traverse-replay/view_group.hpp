#pragma once

#include <array>
#include <string>

#include "console.hpp"
#include "folding_group.hpp"
#include "legend.hpp"

namespace nanogui {
class Button;
class CheckBox;
class ComboBox;
}  // namespace nanogui

namespace traverse::app {

/// What is shown, in which colours, and from where.
class ViewGroup : public FoldingGroup {
 public:
  ViewGroup(nanogui::Widget* parent, Console& console);

  void refresh(const replay::ColourLegend& legend);

 private:
  Console& console_;
  nanogui::ComboBox* colour_;
  Legend* legend_;
  std::array<nanogui::Button*, kCameraNames.size()> cameras_{};
  std::array<nanogui::CheckBox*, kLayerNames.size()> layers_{};
};

}  // namespace traverse::app
