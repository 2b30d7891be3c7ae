#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include <mrpt/gui/CDisplayWindowGUI.h>

#include "console.hpp"
#include "scene.hpp"

namespace traverse::app {

class HelpOverlay;
class Panel;
class TransportBar;

/// How fluent the window was.
struct RedrawReport {
  std::size_t redraws = 0;
  double seconds = 0;          ///< while playing
  double longest_s = 0;        ///< between two rounds of the window's loop, while playing
  std::size_t max_points = 0;  ///< drawn at once
  std::size_t gl_errors = 0;
};

/// The window on a recording: view, panel at the right, time line at the bottom.
class ReplayWindow : public mrpt::gui::CDisplayWindowGUI {
 public:
  ReplayWindow(Console& console, const std::string& title, int width, int height);
  ~ReplayWindow() override;

  /// One round: events, what is new, a redraw if there is anything to draw. \returns false when the
  /// window is to close
  bool round();

  const RedrawReport& report() const { return report_; }

  /// Writes what the window shows as PNG. \throws files::OutputError
  void write_screenshot(const std::filesystem::path& file);

  void drawAll() override;

 private:
  bool resizeEvent(const nanogui::Vector2i& size) override;
  bool keyboardEvent(int key, int scancode, int action, int modifiers) override;
  bool mouseButtonEvent(const nanogui::Vector2i& p, int button, bool down, int modifiers) override;
  bool is_over_view(const nanogui::Vector2i& p) const;

  void arrange();
  void refresh_texts();
  void take_screenshot();
  void move_camera();
  void note_redraw(double seconds, bool playing);

  Console& console_;
  std::string title_;
  std::string titled_;  // pipeline in the title bar
  double scale_;
  Scene scene_;
  Panel* panel_;
  TransportBar* transport_;
  HelpOverlay* help_;
  RedrawReport report_;

  using Clock = std::chrono::steady_clock;
  Clock::time_point last_texts_{};
  Clock::time_point last_drawn_{};
  Clock::time_point last_round_{};
  Clock::time_point last_event_{};
  bool was_playing_ = false;
  double redraw_s_ = 0.03;  // smoothed
  double heading_ = 0;      // of the vehicle at the last redraw, rad
  bool camera_is_placed_ = false;
  CameraMode camera_ = CameraMode::kFree;
};

}  // namespace traverse::app
