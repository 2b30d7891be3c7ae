#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "traverse/replay/script.hpp"

#include "console.hpp"

namespace traverse::app {

class ReplayWindow;

/// Works through a script while the window runs.
class ScriptRunner {
 public:
  /// \throws files::InputError
  explicit ScriptRunner(const std::filesystem::path& file);

  /// Does what can be done now. \returns false when the script is through
  /// \throws std::runtime_error naming the line that failed
  bool work(Console& console, ReplayWindow& window);

 private:
  using Clock = std::chrono::steady_clock;

  bool is_waiting(const replay::ScriptCommand& command, Console& console);
  void do_command(const replay::ScriptCommand& command, Console& console, ReplayWindow& window);
  [[noreturn]] void fail(const replay::ScriptCommand& command, const std::string& why) const;

  std::filesystem::path file_;
  std::vector<replay::ScriptCommand> commands_;
  std::size_t next_ = 0;
  Clock::time_point since_ = Clock::now();  // when the present command was come to
};

}  // namespace traverse::app
