#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace traverse::app {

/// Shows on stderr how far long work has come, at what rate, and how long it still takes.
///
/// On a terminal a bar that redraws itself at most ten times a second; elsewhere (a log) a plain
/// line at the start, at each tenth of the work, and at the end.
class ProgressBar {
 public:
  /// `total` items of `unit` ("frames"); 0 when the number is not known.
  ProgressBar(std::string label, std::size_t total, std::string unit);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void update(std::size_t done);
  /// Draws the final state and ends the line.
  void finish();

 private:
  void draw();
  void print_line() const;
  std::string rate_and_time_left() const;

  std::string label_;
  std::size_t total_;
  std::string unit_;
  bool terminal_;
  bool finished_ = false;
  std::size_t done_ = 0;
  std::size_t next_logged_tenth_ = 1;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_drawn_{};
};

}  // namespace traverse::app
