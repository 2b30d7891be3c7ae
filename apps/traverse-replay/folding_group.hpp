#pragma once

#include <nanogui/widget.h>
#include <string>

namespace nanogui {
class Button;
}

namespace traverse::app {

/// A group of the panel with a title that folds it.
class FoldingGroup : public nanogui::Widget {
 public:
  FoldingGroup(nanogui::Widget* parent, const std::string& title, bool open);

  /// Where the group's widgets go.
  nanogui::Widget* content() { return content_; }
  void set_open(bool open);

 private:
  nanogui::Button* title_;
  nanogui::Widget* content_;
};

}  // namespace traverse::app
