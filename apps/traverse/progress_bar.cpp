#include "progress_bar.hpp"

#include <algorithm>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/number_text.hpp"

#include "standard_streams.hpp"

namespace traverse::app {

using files::clock_text;

namespace {

constexpr std::size_t kBarWidth = 30;
constexpr std::chrono::milliseconds kRedrawInterval{100};

}  // namespace

std::string bar_text(double share) {
  const auto full = static_cast<std::size_t>(share * static_cast<double>(kBarWidth));
  std::string bar;
  for (std::size_t i = 0; i < kBarWidth; ++i) bar += i < full ? "█" : "░";
  return bar;
}

ProgressBar::ProgressBar(std::string label, std::size_t total, std::string unit)
    : label_(std::move(label)),
      total_(total),
      unit_(std::move(unit)),
      terminal_(::isatty(STDERR_FILENO) == 1) {
  if (terminal_) draw();
}

ProgressBar::~ProgressBar() {
  if (terminal_ && !finished_) print_message("\n");  // an error message follows: own line
}

std::optional<double> ProgressBar::share() const {
  if (finished_) return 1;
  if (given_share_) return std::clamp(*given_share_, 0.0, 1.0);
  if (total_ == 0) return std::nullopt;
  return std::min(1.0, static_cast<double>(done_) / static_cast<double>(total_));
}

double ProgressBar::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void ProgressBar::update(std::size_t done, std::optional<double> given_share) {
  done_ = done;
  given_share_ = given_share;
  if (terminal_) {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_drawn_ < kRedrawInterval) return;
    last_drawn_ = now;
    draw();
    return;
  }
  const int tenths = static_cast<int>(share().value_or(0) * 10);
  if (tenths > std::exchange(logged_tenths_, std::max(tenths, logged_tenths_)) && tenths < 10) {
    print_message("{}: {}\n", label_, text());
  }
}

void ProgressBar::finish() {
  if (std::exchange(finished_, true)) return;
  if (terminal_) {
    draw();
    print_message("\n");
  } else {
    print_message("{}: {}\n", label_, text());
  }
}

/// "44/108 frames, 41 %, 21.3 frames/s, 0:03 left"
std::string ProgressBar::text() const {
  const std::optional<double> part = share();
  std::string text = total_ > 0 ? fmt::format("{}/{} {}", done_, total_, unit_)
                                : fmt::format("{} {}", done_, unit_);
  if (part && !finished_) text += fmt::format(", {:.0f} %", 100 * *part);
  const double elapsed = seconds();
  if (done_ > 0 && elapsed > 0) {
    text += fmt::format(", {:.1f} {}/s", static_cast<double>(done_) / elapsed, unit_);
  }
  if (finished_) return text + fmt::format(", {}", clock_text(elapsed));
  if (part && *part > 0) text += fmt::format(", {} left", clock_text(elapsed * (1 / *part - 1)));
  return text;
}

void ProgressBar::draw() const {
  const std::optional<double> part = share();
  print_message("\r\x1b[K{} {}{}", label_, part ? bar_text(*part) + " " : "", text());
}

}  // namespace traverse::app
