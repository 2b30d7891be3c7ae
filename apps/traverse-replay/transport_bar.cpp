#include "transport_bar.hpp"

#include <nanogui/button.h>
#include <nanogui/entypo.h>
#include <nanogui/label.h>
#include <nanogui/layout.h>
#include <nanogui/textbox.h>

#include <fmt/format.h>

#include "traverse/files/number_text.hpp"

namespace traverse::app {

namespace {

using nanogui::Alignment;
using nanogui::Orientation;

constexpr int kButton = 26;

}  // namespace

TransportBar::TransportBar(nanogui::Widget* parent, Console& console)
    : WindowFrame(parent), console_(console) {
  setLayout(new nanogui::BoxLayout(Orientation::Vertical, Alignment::Fill, 2, 0));
  setFixedHeight(kHeight);
  time_bar_ = new TimeBar(this, console);
  buttons_ = new nanogui::Widget(this);
  buttons_->setLayout(new nanogui::BoxLayout(Orientation::Horizontal, Alignment::Middle, 4, 4));
  add_button(ENTYPO_ICON_CONTROLLER_JUMP_TO_START, "First frame [home]", "home");
  add_button(ENTYPO_ICON_CONTROLLER_FAST_BACKWARD, "Ten frames back [shift+left]", "step", "-10");
  add_button(ENTYPO_ICON_CHEVRON_LEFT, "One frame back [left]", "step", "-1");
  play_ = add_button(ENTYPO_ICON_CONTROLLER_PLAY, "Play or pause [space]", "toggle");
  add_button(ENTYPO_ICON_CHEVRON_RIGHT, "One frame on [right]", "step", "1");
  add_button(ENTYPO_ICON_CONTROLLER_FAST_FORWARD, "Ten frames on [shift+right]", "step", "10");
  add_button(ENTYPO_ICON_CONTROLLER_NEXT, "Last frame [end]", "end");
  add_button(ENTYPO_ICON_MINUS, "Half the speed [[]", "slower");
  speed_ = new nanogui::Label(buttons_, "1x");
  speed_->setFixedWidth(36);
  speed_->setTooltip("Speed, times real time");
  add_button(ENTYPO_ICON_PLUS, "Twice the speed []]", "faster");
  unlimited_ = add_button(ENTYPO_ICON_FLASH, "As fast as the estimator can [M]", "");
  unlimited_->setFlags(nanogui::Button::ToggleButton);
  unlimited_->setChangeCallback([this](bool on) { console_.execute("speed", on ? "max" : "1"); });
  loop_ = add_button(ENTYPO_ICON_LOOP, "Begin again at the end [L]", "");
  loop_->setFlags(nanogui::Button::ToggleButton);
  loop_->setChangeCallback([this](bool on) { console_.execute("loop", on ? "on" : "off"); });
  add_button(ENTYPO_ICON_ALIGN_LEFT, "Play range begins here [I]", "range", "from-here");
  add_button(ENTYPO_ICON_ALIGN_RIGHT, "Play range ends here [O]", "range", "to-here");
  add_button(ENTYPO_ICON_CROSS, "No play range [P]", "range", "off");
  go_to_ = new nanogui::TextBox(buttons_, "");
  go_to_->setEditable(true);
  go_to_->setFixedSize({96, kButton});
  go_to_->setPlaceholder("go to");
  go_to_->setTooltip("A frame (120), a time from the start (12.5s, 1:02.5) or a stamp [G]");
  go_to_->setCallback([this](const std::string& text) {
    if (!text.empty()) console_.execute("seek", text);
    go_to_->setValue("");
    return true;
  });
  add_button(ENTYPO_ICON_CAMERA, "Screenshot of this window [S]", "screenshot");
  add_button(ENTYPO_ICON_SAVE, "Save trajectory and map up to this frame [ctrl+S]", "save");
  add_button(ENTYPO_ICON_HELP, "Keys and mouse [H]", "help");
  where_ = new nanogui::Label(buttons_, " ");
  where_->setFixedWidth(330);
  message_ = new nanogui::Label(this, " ");
  message_->setFontSize(13);
}

nanogui::Button* TransportBar::add_button(int icon, const std::string& tip, const std::string& word,
                                          const std::string& argument) {
  auto* button = new nanogui::Button(buttons_, "", icon);
  button->setFixedSize({kButton, kButton});
  button->setTooltip(tip);
  if (!word.empty()) {
    button->setCallback([this, word, argument] { console_.execute(word, argument); });
  }
  return button;
}

void TransportBar::ask_where_to_go() { go_to_->requestFocus(); }

void TransportBar::refresh(const std::string& drawn) {
  time_bar_->refresh();
  const replay::PlayerStatus status = console_.player().status();
  const auto shown = console_.player().shown();
  play_->setIcon(status.playing ? ENTYPO_ICON_CONTROLLER_PAUS : ENTYPO_ICON_CONTROLLER_PLAY);
  loop_->setPushed(status.loop);
  unlimited_->setPushed(status.unlimited);
  speed_->setCaption(status.unlimited ? "max" : fmt::format("{:g}x", status.speed));
  const std::string last = status.frames == 0 ? "?"
                                              : fmt::format("{}{}", status.frames - 1,
                                                            status.frames_complete ? "" : "+");
  std::string where = shown ? fmt::format("  {}   frame {} of {}",
                                          files::clock_text(shown->seconds, 2), shown->frame, last)
                            : "  no frame yet";
  if (status.busy && !status.playing) where += fmt::format(", at {} ...", status.working_on);
  where_->setCaption(where);

  std::string message = !status.error.empty()         ? "Stopped: " + status.error
                        : !console_.message().empty() ? console_.message()
                                                      : status.message;
  if (!status.frames_complete && status.error.empty()) {
    message = fmt::format("indexing {:.0f} %   {}", 100 * status.index_share, message);
  }
  message_->setCaption("  " + drawn + "   " + message);
}

}  // namespace traverse::app
