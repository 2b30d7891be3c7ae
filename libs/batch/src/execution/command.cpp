#include "execution/command.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>
#include <string_view>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/text_file.hpp"

#include "execution/run_process.hpp"

namespace traverse::batch {

namespace {

constexpr double kPatience_s = 120;  // a busy scheduler answers late

/// Messages of Slurm's own errors that pass: slurm_errno.c and the network below it.
constexpr std::array<std::string_view, 12> kPassing{"socket timed out",
                                                    "unable to contact slurm controller",
                                                    "communication connection failure",
                                                    "connection refused",
                                                    "connection timed out",
                                                    "connection reset",
                                                    "zero bytes were transmitted",
                                                    "transport endpoint",
                                                    "resource temporarily unavailable",
                                                    "temporarily unable to accept job",
                                                    "in standby mode",
                                                    "try again later"};

void wait_for(std::chrono::milliseconds time, const std::atomic<bool>& stop) {
  constexpr std::chrono::milliseconds kTick{50};
  for (; time.count() > 0 && !stop; time -= kTick) {
    std::this_thread::sleep_for(std::min(time, kTick));
  }
}

}  // namespace

std::string command_output(const std::vector<std::string>& words,
                           const std::filesystem::path& folder) {
  const files::AtomicFile answer(folder / "command");  // never committed
  const std::filesystem::path& log = answer.temporary_path();
  ProcessStart start{"/usr/bin/env", words, folder, log};
  start.time_limit_s = kPatience_s;
  const std::atomic<bool> stop{false};
  const ProcessEnd end = run_process(start, stop);
  const std::string output = files::read_text(log);
  if (end.exit_status != 0 || end.signal != 0) {
    throw std::runtime_error(fmt::format("`{}` failed: {}", fmt::join(words, " "),
                                         end.signal != 0 ? "no answer" : output));
  }
  return output;
}

bool is_passing(const std::string& message) {
  std::string small = message;
  std::transform(small.begin(), small.end(), small.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::any_of(kPassing.begin(), kPassing.end(), [&](std::string_view words) {
    return small.find(words) != std::string::npos;
  });
}

std::string patient_output(const std::vector<std::string>& words,
                           const std::filesystem::path& folder, const Waits& waits,
                           const std::atomic<bool>& stop) {
  for (std::size_t tries = 1;; ++tries) {
    try {
      return command_output(words, folder);
    } catch (const std::runtime_error& error) {
      if (!is_passing(error.what())) throw;
      if (stop || tries > waits.size()) {
        throw std::runtime_error(fmt::format("{} ({} tries)", error.what(), tries));
      }
    }
    wait_for(waits[tries - 1], stop);
  }
}

}  // namespace traverse::batch
