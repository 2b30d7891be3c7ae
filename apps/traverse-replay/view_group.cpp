#include "view_group.hpp"

#include <nanogui/button.h>
#include <nanogui/checkbox.h>
#include <nanogui/combobox.h>
#include <nanogui/layout.h>
#include <nanogui/popup.h>

#include "layer_colours.hpp"
#include "swatch.hpp"

namespace traverse::app {

namespace {

using nanogui::Alignment;
using nanogui::Orientation;

constexpr std::array<const char*, kCameraNames.size()> kCameraTexts{"Follow", "Top", "Free"};
constexpr std::array<const char*, kCameraNames.size()> kCameraTips{
    "Behind the vehicle; the mouse turns, the wheel zooms [F]",
    "Straight from above, without perspective [T]",
    "Stays where the mouse puts it: left turns, right moves, wheel zooms [V]"};
constexpr std::array<const char*, kLayerNames.size()> kLayerTips{
    "The scan of this frame as the estimator used it [1]",
    "The map of all frames so far: all points near, fewer far away [2]",
    "The points that the next scan will be registered on [3]",
    "Points of this scan with the lines (orange) and planes (green) they were registered on [4]",
    "The estimated trajectory [5]",
    "The reference trajectory, aligned at the first frame, dashed [6]",
    "A grid of 10 m; of 2 m where a robot goes with a 2-D laser [7]"};

}  // namespace

ViewGroup::ViewGroup(nanogui::Widget* parent, Console& console)
    : FoldingGroup(parent, "View", true), console_(console) {
  auto* cameras = new nanogui::Widget(content());
  cameras->setLayout(new nanogui::GridLayout(Orientation::Horizontal, 3, Alignment::Fill, 0, 4));
  for (std::size_t i = 0; i < kCameraNames.size(); ++i) {
    cameras_[i] = new nanogui::Button(cameras, kCameraTexts[i]);
    cameras_[i]->setFlags(nanogui::Button::RadioButton);
    cameras_[i]->setFixedWidth(86);
    cameras_[i]->setTooltip(kCameraTips[i]);
    cameras_[i]->setCallback([this, i] { console_.execute("view", std::string(kCameraNames[i])); });
  }

  std::vector<std::string> names;
  for (const auto& [name, colour] : replay::kScanColourNames) {
    names.push_back("Scan by " + std::string(name));
  }
  colour_ = new nanogui::ComboBox(content(), names);
  colour_->popup()->setSide(nanogui::Popup::Side::Left);
  colour_->setTooltip("What the colours of the scan mean [C for the next]");
  colour_->setCallback([this](int index) {
    console_.execute(
        "colour", std::string(replay::kScanColourNames.at(static_cast<std::size_t>(index)).first));
  });
  legend_ = new Legend(content());

  auto* layers = new nanogui::Widget(content());
  layers->setLayout(new nanogui::GridLayout(Orientation::Horizontal, 4, Alignment::Minimum, 0, 2));
  for (std::size_t i = 0; i < kLayerNames.size(); ++i) {
    (new Swatch(layers, colours_of(static_cast<Layer>(i))))->setTooltip(kLayerTips[i]);
    std::string title(kLayerNames[i]);
    if (title == "local-map") title = "local map";
    layers_[i] = new nanogui::CheckBox(layers, title);
    layers_[i]->setFixedSize({112, 20});
    layers_[i]->setTooltip(kLayerTips[i]);
    layers_[i]->setCallback([this, i](bool on) {
      console_.execute("show", std::string(kLayerNames[i]) + (on ? " on" : " off"));
    });
  }
}

void ViewGroup::refresh(const replay::ColourLegend& legend) {
  const ViewSettings& view = console_.view();
  for (std::size_t i = 0; i < kCameraNames.size(); ++i) {
    cameras_[i]->setPushed(static_cast<std::size_t>(view.camera) == i);
  }
  for (std::size_t i = 0; i < replay::kScanColourNames.size(); ++i) {
    if (replay::kScanColourNames[i].second == view.colour &&
        colour_->selectedIndex() != static_cast<int>(i)) {
      colour_->setSelectedIndex(static_cast<int>(i));
    }
  }
  for (std::size_t i = 0; i < kLayerNames.size(); ++i) layers_[i]->setChecked(view.layers[i]);
  legend_->set(legend);
}

}  // namespace traverse::app
