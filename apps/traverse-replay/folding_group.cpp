#include "folding_group.hpp"

#include <nanogui/button.h>
#include <nanogui/entypo.h>
#include <nanogui/layout.h>
#include <nanogui/screen.h>

namespace traverse::app {

namespace {

constexpr int kSpacing = 4;
constexpr int kIndent = 8;
constexpr int kTitleHeight = 24;

}  // namespace

FoldingGroup::FoldingGroup(nanogui::Widget* parent, const std::string& title, bool open)
    : nanogui::Widget(parent) {
  setLayout(new nanogui::BoxLayout(nanogui::Orientation::Vertical, nanogui::Alignment::Fill, 0,
                                   kSpacing));
  title_ = new nanogui::Button(this, title, ENTYPO_ICON_CHEVRON_DOWN);
  title_->setIconPosition(nanogui::Button::IconPosition::Left);
  title_->setFixedHeight(kTitleHeight);
  title_->setTooltip("Fold or unfold");
  content_ = new nanogui::Widget(this);
  content_->setLayout(new nanogui::BoxLayout(nanogui::Orientation::Vertical,
                                             nanogui::Alignment::Fill, kIndent, kSpacing));
  title_->setCallback([this] { set_open(!content_->visible()); });
  content_->setVisible(open);
  title_->setIcon(open ? ENTYPO_ICON_CHEVRON_DOWN : ENTYPO_ICON_CHEVRON_RIGHT);
}

void FoldingGroup::set_open(bool open) {
  content_->setVisible(open);
  title_->setIcon(open ? ENTYPO_ICON_CHEVRON_DOWN : ENTYPO_ICON_CHEVRON_RIGHT);
  screen()->performLayout();
}

}  // namespace traverse::app
