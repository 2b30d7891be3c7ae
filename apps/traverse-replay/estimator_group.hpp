#pragma once

#include <string>
#include <vector>

#include "traverse/pipeline/preset.hpp"

#include "console.hpp"
#include "folding_group.hpp"

namespace nanogui {
class ComboBox;
class Label;
class TextBox;
}  // namespace nanogui

namespace traverse::app {

/// The pipeline at work, and another one or other settings to begin again with.
class EstimatorGroup : public FoldingGroup {
 public:
  EstimatorGroup(nanogui::Widget* parent, Console& console);

  void refresh();

 private:
  void choose_setting(std::size_t index);
  void restart(const std::string& where);

  Console& console_;
  nanogui::Label* present_;
  std::vector<pipeline::PresetSummary> presets_;
  nanogui::ComboBox* preset_ = nullptr;
  nanogui::ComboBox* setting_ = nullptr;
  nanogui::TextBox* value_ = nullptr;
  std::vector<pipeline::ResolvedSetting> settings_;
  std::size_t chosen_ = 0;
  unsigned generation_ = 0;
};

}  // namespace traverse::app
