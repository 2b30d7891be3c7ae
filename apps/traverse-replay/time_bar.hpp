#pragma once

#include <nanogui/widget.h>
#include <vector>

#include "console.hpp"

namespace traverse::app {

/// The recording from left to right: what the index knows, what was estimated and how well, the
/// play range, records that were skipped, and the frame on show. A click or a drag seeks.
class TimeBar : public nanogui::Widget {
 public:
  TimeBar(nanogui::Widget* parent, Console& console);

  void refresh();  ///< at most ten times a second: reads the player

  void draw(NVGcontext* context) override;
  bool mouseButtonEvent(const nanogui::Vector2i& p, int button, bool down, int modifiers) override;
  bool mouseDragEvent(const nanogui::Vector2i& p, const nanogui::Vector2i& rel, int button,
                      int modifiers) override;
  nanogui::Vector2i preferredSize(NVGcontext*) const override { return {600, 34}; }

 private:
  float x_of(double frame) const;
  void seek_to(int x);
  void draw_estimated(NVGcontext* context, float top, float height) const;
  void draw_marks(NVGcontext* context, float top, float height) const;

  Console& console_;
  replay::PlayerStatus status_;
  std::vector<replay::FrameIndex::Skipped> skipped_;
  std::vector<double> errors_;  // by frame from the origin; -1 without reference
  std::vector<bool> registered_;
  unsigned generation_ = 0;
};

}  // namespace traverse::app
