#include "script_runner.hpp"

#include <stdexcept>

#include <fmt/format.h>

#include "traverse/files/numbers.hpp"

#include "replay_window.hpp"

namespace traverse::app {

namespace {

constexpr double kLongestWait = 300;  // seconds, for a frame

}  // namespace

ScriptRunner::ScriptRunner(const std::filesystem::path& file)
    : file_(file), commands_(replay::read_script(file)) {}

bool ScriptRunner::work(Console& console, ReplayWindow& window) {
  while (next_ < commands_.size()) {
    const replay::ScriptCommand& command = commands_[next_];
    if (is_waiting(command, console)) return true;
    do_command(command, console, window);
    ++next_;
    since_ = Clock::now();
  }
  return false;
}

bool ScriptRunner::is_waiting(const replay::ScriptCommand& command, Console& console) {
  const double waited = std::chrono::duration<double>(Clock::now() - since_).count();
  if (command.name == "wait") {
    const auto seconds = files::parse_double(command.argument);
    if (!seconds) fail(command, "expected seconds");
    return waited < *seconds;
  }
  const replay::PlayerStatus status = console.player().status();
  bool waits = false;
  if (command.name == "settle") waits = !status.settled;
  if (command.name == "wait-frame") {
    const auto frame = files::parse_integer(command.argument);
    if (!frame || *frame < 0) fail(command, "expected a frame");
    waits = !status.shown || *status.shown < static_cast<std::size_t>(*frame);
  }
  if (waits && !status.error.empty()) fail(command, status.error);
  if (waits && waited > kLongestWait) fail(command, "waited for too long");
  return waits;
}

void ScriptRunner::do_command(const replay::ScriptCommand& command, Console& console,
                              ReplayWindow& window) {
  if (command.name == "wait" || command.name == "settle" || command.name == "wait-frame") return;
  if (command.name == "expect-frame") {
    const auto shown = console.player().status().shown;
    const std::string found = shown ? std::to_string(*shown) : "none";
    if (found != command.argument) fail(command, "frame " + found + " is on show");
    return;
  }
  if (command.name == "screenshot") {
    window.write_screenshot(command.argument);
    return;
  }
  const std::string fault = console.execute(command.name, command.argument);
  if (!fault.empty()) fail(command, fault);
}

void ScriptRunner::fail(const replay::ScriptCommand& command, const std::string& why) const {
  throw std::runtime_error(fmt::format("{}, line {}: {} {}: {}", file_.string(), command.line,
                                       command.name, command.argument, why));
}

}  // namespace traverse::app
