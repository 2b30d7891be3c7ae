#pragma once

#include <string>
#include <vector>

#include "console.hpp"
#include "folding_group.hpp"

namespace nanogui {
class Label;
}

namespace traverse::app {

/// How the frame on show went: the health record's telling values.
class HealthGroup : public FoldingGroup {
 public:
  HealthGroup(nanogui::Widget* parent, Console& console);

  void refresh();

 private:
  struct Row {
    std::string column;
    nanogui::Label* name;
    nanogui::Label* value;
  };

  void choose_rows();

  Console& console_;
  nanogui::Widget* table_;
  std::vector<std::string> columns_;
  std::vector<Row> rows_;
};

}  // namespace traverse::app
