#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

namespace traverse::app {

/// "██████░░░░", thirty wide, for a share from 0 to 1.
std::string bar_text(double share);

/// Shows on stderr how far long work has come, at what rate, and how long it still takes.
///
/// On a terminal a bar that redraws itself at most ten times a second; elsewhere (a log) a plain
/// line at each tenth of the work and at the end.
class ProgressBar {
 public:
  /// `total` items of `unit` ("frames"); 0 when the number is not known before.
  ProgressBar(std::string label, std::size_t total, std::string unit);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// \param share of the work that is done, 0 to 1, where it is known otherwise than by `total`
  void update(std::size_t done, std::optional<double> share = std::nullopt);
  /// Draws the final state and ends the line.
  void finish();

 private:
  std::optional<double> share() const;
  double seconds() const;
  std::string text() const;
  void draw() const;

  std::string label_;
  std::size_t total_;
  std::string unit_;
  bool terminal_;
  bool finished_ = false;
  std::size_t done_ = 0;
  std::optional<double> given_share_;
  int logged_tenths_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_drawn_{};
};

}  // namespace traverse::app
