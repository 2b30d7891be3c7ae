#include "execution/command.hpp"

#include <atomic>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/text_file.hpp"

#include "execution/run_process.hpp"

namespace traverse::batch {

namespace {
constexpr double kPatience_s = 120;  // a busy scheduler answers late
}

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

}  // namespace traverse::batch
