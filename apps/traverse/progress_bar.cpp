#include "progress_bar.hpp"

#include <algorithm>
#include <cstdio>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

namespace traverse::app {

namespace {

constexpr std::size_t kBarWidth = 30;
constexpr std::chrono::milliseconds kRedrawInterval{100};

std::string clock_text(double seconds) {
  const auto whole = static_cast<long>(seconds + 0.5);
  return whole < 3600 ? fmt::format("{}:{:02d}", whole / 60, whole % 60)
                      : fmt::format("{}:{:02d}:{:02d}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string bar_text(double share) {
  const auto full = static_cast<std::size_t>(share * static_cast<double>(kBarWidth));
  std::string bar;
  for (std::size_t i = 0; i < kBarWidth; ++i) bar += i < full ? "█" : "░";
  return bar;
}

}  // namespace

ProgressBar::ProgressBar(std::string label, std::size_t total, std::string unit)
    : label_(std::move(label)),
      total_(total),
      unit_(std::move(unit)),
      terminal_(::isatty(STDERR_FILENO) == 1) {
  if (terminal_) {
    draw();
  } else if (total_ > 0) {
    fmt::print(stderr, "{}: {} {}\n", label_, total_, unit_);
  }
}

ProgressBar::~ProgressBar() {
  if (terminal_ && !finished_) fmt::print(stderr, "\n");  // an error message follows: own line
}

void ProgressBar::update(std::size_t done) {
  done_ = done;
  const auto now = std::chrono::steady_clock::now();
  if (terminal_) {
    if (now - last_drawn_ < kRedrawInterval) return;
    last_drawn_ = now;
    draw();
  } else if (total_ > 0 && done_ * 10 >= next_logged_tenth_ * total_ && done_ < total_) {
    next_logged_tenth_ = done_ * 10 / total_ + 1;
    print_line();
  }
}

void ProgressBar::finish() {
  if (std::exchange(finished_, true)) return;
  if (terminal_) {
    draw();
    fmt::print(stderr, "\n");
  } else {
    print_line();
  }
}

std::string ProgressBar::rate_and_time_left() const {
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  if (done_ == 0 || seconds <= 0) return "";
  const double rate = static_cast<double>(done_) / seconds;
  if (finished_ || total_ == 0) {
    return fmt::format("{:.1f} {}/s  {} elapsed", rate, unit_, clock_text(seconds));
  }
  const double left = static_cast<double>(total_ - std::min(done_, total_)) / rate;
  return fmt::format("{:.1f} {}/s  {} left", rate, unit_, clock_text(left));
}

void ProgressBar::draw() {
  if (total_ == 0) {
    fmt::print(stderr, "\r\x1b[K{}  {} {}  {}", label_, done_, unit_, rate_and_time_left());
  } else {
    const double share = std::min(1.0, static_cast<double>(done_) / static_cast<double>(total_));
    fmt::print(stderr, "\r\x1b[K{} {} {:3.0f} %  {}/{} {}  {}", label_, bar_text(share),
               100 * share, done_, total_, unit_, rate_and_time_left());
  }
  std::fflush(stderr);
}

void ProgressBar::print_line() const {
  if (total_ == 0) {
    fmt::print(stderr, "{}: {} {}  {}\n", label_, done_, unit_, rate_and_time_left());
  } else {
    fmt::print(stderr, "{}: {}/{} {}  {}\n", label_, done_, total_, unit_, rate_and_time_left());
  }
}

}  // namespace traverse::app
