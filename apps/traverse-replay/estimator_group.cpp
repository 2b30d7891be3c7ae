#include "estimator_group.hpp"

#include <algorithm>
#include <nanogui/button.h>
#include <nanogui/combobox.h>
#include <nanogui/label.h>
#include <nanogui/layout.h>
#include <nanogui/popup.h>
#include <nanogui/screen.h>
#include <nanogui/textbox.h>

#include <fmt/format.h>

namespace traverse::app {

namespace {

using nanogui::Alignment;
using nanogui::Orientation;

/// A popup list of settings has room for so many lines.
constexpr std::size_t kMostSettings = 26;
constexpr int kBoxHeight = 24;

/// The settings that change most, in the order of the list; the rest is for configuration files.
bool is_main(const std::string& path) {
  return !path.starts_with("start.") && !path.starts_with("thinning.") &&
         path.find("grazing") == std::string::npos && path.find("break") == std::string::npos;
}

}  // namespace

EstimatorGroup::EstimatorGroup(nanogui::Widget* parent, Console& console)
    : FoldingGroup(parent, "Estimator", true), console_(console) {
  present_ = new nanogui::Label(content(), " ");
  present_->setFixedWidth(270);
  present_->setTooltip(
      "The pipeline at work, and the memory of the copies that make going back quick");
  const replay::Recording& recording = console.player().recording();
  if (recording.is_run() || !recording.has_lidar()) return;  // nothing to choose

  presets_ = pipeline::list_presets(recording.share_folder());
  std::vector<std::string> names;
  for (const auto& preset : presets_) names.push_back(preset.name);
  preset_ = new nanogui::ComboBox(content(), names);
  preset_->popup()->setSide(nanogui::Popup::Side::Left);
  preset_->setTooltip("The pipeline that the buttons below begin");
  preset_->setCallback([this](int index) {
    console_.execute("pipeline", presets_.at(static_cast<std::size_t>(index)).name);
  });

  setting_ = new nanogui::ComboBox(content(), {"-"});
  setting_->popup()->setSide(nanogui::Popup::Side::Left);
  setting_->setTooltip("A setting to change; `traverse pipelines NAME` lists all of them");
  setting_->setCallback([this](int index) { choose_setting(static_cast<std::size_t>(index)); });
  value_ = new nanogui::TextBox(content(), "");
  value_->setEditable(true);
  value_->setFixedHeight(kBoxHeight);
  value_->setAlignment(nanogui::TextBox::Alignment::Left);
  value_->setCallback([this](const std::string& text) {
    if (chosen_ >= settings_.size()) return false;
    console_.execute("set", settings_[chosen_].setting.path + "=" + text);
    return true;
  });

  auto* buttons = new nanogui::Widget(content());
  buttons->setLayout(new nanogui::GridLayout(Orientation::Horizontal, 2, Alignment::Fill, 0, 4));
  auto* here = new nanogui::Button(buttons, "Restart here");
  here->setTooltip("Begins the chosen pipeline at the frame on show [R]");
  here->setCallback([this] { restart("here"); });
  auto* start = new nanogui::Button(buttons, "From the start");
  start->setTooltip("Begins the chosen pipeline at the first frame [shift+R]");
  start->setCallback([this] { restart("start"); });
  for (auto* button : {here, start}) button->setFixedWidth(130);
}

void EstimatorGroup::restart(const std::string& where) {
  // What stands in the box counts even if the return key was not pressed.
  if (value_ != nullptr && chosen_ < settings_.size()) {
    const auto& setting = settings_[chosen_].setting;
    if (value_->value() != config::to_text(setting.value)) {
      console_.execute("set", setting.path + "=" + value_->value());
    }
  }
  console_.execute("restart", where);
}

void EstimatorGroup::choose_setting(std::size_t index) {
  if (index >= settings_.size()) return;
  chosen_ = index;
  const config::Setting& setting = settings_[index].setting;
  value_->setValue(config::to_text(setting.value));
  value_->setTooltip(setting.allowed.empty() ? setting.meaning
                                             : setting.meaning + " (" + setting.allowed + ")");
}

void EstimatorGroup::refresh() {
  const replay::PlayerStatus status = console_.player().status();
  present_->setCaption(fmt::format("{}   (steps back: {:.0f} MB)", status.pipeline,
                                   static_cast<double>(status.checkpoint_bytes) / (1 << 20)));
  if (preset_ == nullptr) return;
  for (std::size_t i = 0; i < presets_.size(); ++i) {
    if (presets_[i].name == console_.request().name &&
        preset_->selectedIndex() != static_cast<int>(i)) {
      preset_->setSelectedIndex(static_cast<int>(i));
    }
  }
  if (status.generation == generation_) return;
  generation_ = status.generation;
  settings_ = console_.player().settings();
  std::erase_if(settings_, [](const auto& entry) { return !is_main(entry.setting.path); });
  if (settings_.size() > kMostSettings) settings_.resize(kMostSettings);
  std::vector<std::string> names;
  for (const auto& entry : settings_) names.push_back(entry.setting.path);
  setting_->setItems(names);
  chosen_ = std::min(chosen_, settings_.empty() ? 0 : settings_.size() - 1);
  setting_->setSelectedIndex(static_cast<int>(chosen_));
  choose_setting(chosen_);
  screen()->performLayout();
}

}  // namespace traverse::app
