#include "command.hpp"

#include <atomic>
#include <stdexcept>
#include <system_error>
#include <unistd.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/files/text_file.hpp"

#include "run_process.hpp"

namespace traverse::batch {

namespace {
constexpr double kPatience_s = 120;  // a busy scheduler answers late
}

std::string command_output(const std::vector<std::string>& words,
                           const std::filesystem::path& folder) {
  const std::filesystem::path log = folder / fmt::format(".command.{}", ::getpid());
  ProcessStart start{"/usr/bin/env", words, folder, log};
  start.time_limit_s = kPatience_s;
  const std::atomic<bool> stop{false};
  const ProcessEnd end = run_process(start, stop);
  const std::string output = files::read_text(log);
  std::error_code ignored;
  std::filesystem::remove(log, ignored);
  if (end.exit_status != 0 || end.signal != 0) {
    throw std::runtime_error(fmt::format("`{}` failed: {}", fmt::join(words, " "),
                                         end.signal != 0 ? "no answer" : output));
  }
  return output;
}

}  // namespace traverse::batch
