#pragma once

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <sys/wait.h>
#include <thread>

#include <fmt/format.h>

#include "traverse/files/text_file.hpp"

namespace traverse::testing {

inline std::string output_of(const std::string& command) {
  std::string output;
  FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return output;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) output += static_cast<char>(c);
  ::pclose(pipe);
  while (!output.empty() && output.back() == '\n') output.pop_back();
  return output;
}

inline bool is_installed(const std::string& program) {
  return std::system(("command -v " + program + " > /dev/null").c_str()) == 0;
}

template <typename Condition>
bool eventually(const Condition& condition, double seconds = 120) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

/// A screen of its own (Xvfb), gone with the test.
class Screen {
 public:
  explicit Screen(const std::filesystem::path& folder) {
    const std::string file = (folder / "display").string();
    pid_ = output_of(
        fmt::format("Xvfb -displayfd 3 -noreset -screen 0 1100x800x24 +extension GLX 3> '{}' "
                    "> /dev/null 2>&1 & echo $!",
                    file));
    eventually([&] { return std::filesystem::exists(file) && !files::read_text(file).empty(); },
               30);
    display_ = ":" + output_of("cat '" + file + "'");
  }
  /// Waits for its end: dying it would take the socket of a next one with the same number along.
  ~Screen() {
    output_of("kill " + pid_);
    eventually([&] { return !std::filesystem::exists("/proc/" + pid_); }, 30);
  }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  std::string run(const std::string& command) const {
    return output_of("DISPLAY=" + display_ + " " + command);
  }
  const std::string& display() const { return display_; }

 private:
  std::string pid_;
  std::string display_;
};

/// Of the window, pixels.
struct Place {
  int x, y;
};

/// A program with a window on the screen, driven by key presses and mouse clicks.
class WindowedProgram {
 public:
  WindowedProgram(const Screen& screen, const std::filesystem::path& folder,
                  const std::string& arguments)
      : screen_(screen), status_file_(folder / "status"), messages_file_(folder / "messages") {
    std::filesystem::remove(status_file_);
    std::system(fmt::format("( cd '{}'; DISPLAY={} '{}' {} > output 2> messages; echo $? > "
                            "status.new; mv status.new status ) &",
                            folder.string(), screen.display(), TRAVERSE_REPLAY_PROGRAM, arguments)
                    .c_str());
  }

  /// Waits for the window and gives it the keyboard.
  bool has_window() {
    const bool found = eventually([&] {
      window_ = screen_.run("xdotool search --onlyvisible --name 'Traverse replay' 2> /dev/null");
      return !window_.empty() || has_ended();
    });
    if (found && !window_.empty()) {
      screen_.run(fmt::format("xdotool windowmove {} 0 0 windowfocus {}", window_, window_));
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
    }
    return found && !window_.empty();
  }

  void press(const std::string& key) {
    screen_.run("xdotool key --delay 60 " + key);
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
  }
  /// Slowly: the window looks at the mouse once a redraw.
  void click(Place place) {
    screen_.run(
        fmt::format("xdotool mousemove {} {} sleep 0.3 mousedown 1 sleep 0.3 mouseup 1 "
                    "sleep 0.3",
                    place.x, place.y));
  }

  std::string title() const { return screen_.run("xdotool getwindowname " + window_); }

  bool has_ended() const { return std::filesystem::exists(status_file_); }
  int exit_status() {
    if (!eventually([&] { return has_ended(); })) return -1;
    return std::atoi(files::read_text(status_file_).c_str());
  }
  std::string messages() const { return files::read_text(messages_file_); }

 private:
  const Screen& screen_;
  std::filesystem::path status_file_;
  std::filesystem::path messages_file_;
  std::string window_;
};

}  // namespace traverse::testing
