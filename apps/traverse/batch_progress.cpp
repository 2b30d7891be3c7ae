#include "batch_progress.hpp"

#include <algorithm>
#include <fstream>
#include <sys/ioctl.h>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

#include "traverse/batch/execute.hpp"
#include "traverse/files/number_text.hpp"

#include "progress_bar.hpp"
#include "standard_streams.hpp"

namespace traverse::app {

using files::clock_text;

namespace {

constexpr std::size_t kMostRunningLines = 16;
constexpr std::chrono::milliseconds kBatchRedrawInterval{250};

double share_of(const batch::BatchState& state) {
  return state.to_do == 0 ? 1 : static_cast<double>(state.made) / static_cast<double>(state.to_do);
}

std::size_t not_ok(const batch::BatchState& state) {
  std::size_t count = 0;
  for (const auto& [outcome, rows] : state.outcomes) {
    if (outcome != batch::Outcome::kOk) count += rows;
  }
  return count;
}

std::size_t terminal_width() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

/// What the run's log says last: "floam: 44/108 frames, 41 %, ...".
std::string last_line(const std::filesystem::path& log) {
  constexpr std::streamoff kTail = 400;
  std::ifstream stream(log, std::ios::binary | std::ios::ate);
  if (!stream) return "";
  const std::streamoff size = stream.tellg();
  stream.seekg(std::max<std::streamoff>(0, size - kTail));
  std::string last;
  for (std::string line; std::getline(stream, line);) last = line;
  return last;
}

}  // namespace

BatchProgress::BatchProgress(batch::BatchFolder folder)
    : folder_(std::move(folder)), terminal_(::isatty(STDERR_FILENO) == 1) {}

BatchProgress::~BatchProgress() { erase(); }

double BatchProgress::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

/// "12/40 runs, 30 %, 1.9 runs/s, 0:15 left, 1 not ok"
std::string BatchProgress::total_text(const batch::BatchState& state) const {
  std::string text =
      fmt::format("{}/{} runs, {:.0f} %", state.made, state.to_do, 100 * share_of(state));
  if (state.made > 0) {
    const double rate = static_cast<double>(state.made) / seconds();
    text += rate >= 1 ? fmt::format(", {:.1f} runs/s", rate)
                      : fmt::format(", {:.1f} runs/min", 60 * rate);
    if (state.made < state.to_do) {
      text += fmt::format(", {} left",
                          clock_text(static_cast<double>(state.to_do - state.made) / rate));
    }
  }
  if (const std::size_t count = not_ok(state); count > 0) text += fmt::format(", {} not ok", count);
  return text;
}

void BatchProgress::erase() {
  if (lines_ == 0) return;
  print_message("\x1b[{}F\x1b[J", lines_);
  lines_ = 0;
}

void BatchProgress::print_line(const std::string& text) {
  erase();
  print_message("{}\n", text);
}

void BatchProgress::preparing(const std::string& text) { print_line(text + " ..."); }

void BatchProgress::began(const batch::BatchState& state) {
  start_ = std::chrono::steady_clock::now();
  if (state.finished > 0) {
    print_line(fmt::format("{} of {} runs are finished already", state.finished, state.distinct));
  }
}

void BatchProgress::finished(const batch::BatchState& state, const batch::Job& job,
                             const batch::Completion& completion) {
  if (completion.outcome != batch::Outcome::kOk) {
    print_line(
        fmt::format("{}: {}: {}", job.title(), name_of(completion.outcome), completion.reason));
  }
  if (terminal_) return;
  const int tenths = static_cast<int>(10 * share_of(state));
  if (tenths > std::exchange(logged_tenths_, std::max(tenths, logged_tenths_))) {
    print_line("batch: " + total_text(state));
  }
}

void BatchProgress::tick(const batch::BatchState& state,
                         const std::vector<batch::RunningJob>& running) {
  if (!terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_drawn_ < kBatchRedrawInterval) return;
  last_drawn_ = now;
  const std::size_t width = terminal_width();
  std::string text = fmt::format("batch {} {}\n", bar_text(share_of(state)), total_text(state));
  std::size_t lines = 1;
  for (const batch::RunningJob& job : running) {
    if (lines > kMostRunningLines) {
      text += fmt::format("  and {} more\n", running.size() - kMostRunningLines);
      ++lines;
      break;
    }
    const std::string line = fmt::format(
        "  {:>6}  {}  {}", clock_text(std::chrono::duration<double>(now - job.since).count()),
        job.job->title(), last_line(log_in_work(folder_, *job.job)));
    text += line.substr(0, width - 1) + "\n";
    ++lines;
  }
  erase();
  print_message("{}", text);
  lines_ = lines;
}

}  // namespace traverse::app
