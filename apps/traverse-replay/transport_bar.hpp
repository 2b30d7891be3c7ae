#pragma once

#include <string>

#include "console.hpp"
#include "time_bar.hpp"
#include "window_frame.hpp"

namespace nanogui {
class Button;
class Label;
class TextBox;
}  // namespace nanogui

namespace traverse::app {

/// The strip at the bottom: time line and the controls of playing.
class TransportBar : public WindowFrame {
 public:
  static constexpr int kHeight = 88;

  TransportBar(nanogui::Widget* parent, Console& console);

  /// At most ten times a second. \param drawn what the last redraws took, in words
  void refresh(const std::string& drawn);

  /// Lets the user type where to go.
  void ask_where_to_go();

 private:
  nanogui::Button* add_button(int icon, const std::string& tip, const std::string& word,
                              const std::string& argument = "");

  Console& console_;
  TimeBar* time_bar_;
  nanogui::Widget* buttons_;
  nanogui::Button* play_;
  nanogui::Button* loop_;
  nanogui::Button* unlimited_;
  nanogui::Label* speed_;
  nanogui::Label* where_;
  nanogui::TextBox* go_to_;
  nanogui::Label* message_;
};

}  // namespace traverse::app
