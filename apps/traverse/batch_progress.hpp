#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "traverse/batch/batch.hpp"

namespace traverse::app {

/// Shows on stderr how far a batch is.
///
/// On a terminal: a bar for all runs with rate and time left, and below it a line for each run that
/// is at work with what its log says last, redrawn a few times a second. Elsewhere (a log): a line
/// at each tenth of the runs and one for each run that is not ok.
class BatchProgress {
 public:
  explicit BatchProgress(batch::BatchFolder folder);
  ~BatchProgress();
  BatchProgress(const BatchProgress&) = delete;
  BatchProgress& operator=(const BatchProgress&) = delete;

  void preparing(const std::string& text);
  void began(const batch::BatchState& state);
  void finished(const batch::BatchState& state, const batch::Job& job,
                const batch::Completion& completion);
  void tick(const batch::BatchState& state, const std::vector<batch::RunningJob>& running);

 private:
  double seconds() const;
  std::string total_text(const batch::BatchState& state) const;
  void print_line(const std::string& text);
  void erase();

  batch::BatchFolder folder_;
  bool terminal_;
  std::size_t lines_ = 0;  ///< that stand on the terminal and are drawn again
  int logged_tenths_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_drawn_{};
};

}  // namespace traverse::app
