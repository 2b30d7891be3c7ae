#pragma once

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "traverse/files/numbers.hpp"
#include "traverse/files/text_file.hpp"

namespace traverse::testing {

/// `traverse batch PLAN -o OUT` in a process that the test can kill.
class BatchProcess {
 public:
  BatchProcess(const std::filesystem::path& plan, const std::filesystem::path& out)
      : pid_(::fork()) {
    if (pid_ != 0) return;
    const std::string log = out.string() + ".log";
    if (std::freopen(log.c_str(), "a", stdout) == nullptr ||
        std::freopen(log.c_str(), "a", stderr) == nullptr) {
      ::_exit(126);
    }
    ::execl(TRAVERSE_PROGRAM, "traverse", "batch", plan.c_str(), "-o", out.c_str(), "--jobs", "4",
            nullptr);
    ::_exit(127);
  }
  ~BatchProcess() {
    if (!ended_) kill();
  }
  BatchProcess(const BatchProcess&) = delete;
  BatchProcess& operator=(const BatchProcess&) = delete;

  bool has_ended() {
    if (!ended_) ended_ = ::waitpid(pid_, &status_, WNOHANG) == pid_;
    return ended_;
  }
  int exit_status() const { return WIFEXITED(status_) ? WEXITSTATUS(status_) : -1; }
  void kill() {
    ::kill(pid_, SIGKILL);
    ended_ = ::waitpid(pid_, &status_, 0) == pid_;
  }
  /// The processes that it started: its runs.
  std::vector<pid_t> workers() const {
    std::vector<pid_t> pids;
    for (const auto& task :
         std::filesystem::directory_iterator("/proc/" + std::to_string(pid_) + "/task")) {
      try {
        const std::string text = files::read_text(task.path() / "children");
        for (const auto word : files::split_words(text)) {
          if (const auto pid = files::parse_integer(word)) pids.push_back(static_cast<pid_t>(*pid));
        }
      } catch (const files::InputError&) {
        // The thread has ended meanwhile.
      }
    }
    return pids;
  }

 private:
  pid_t pid_;
  int status_ = 0;
  bool ended_ = false;
};

/// results.csv without what is measured by the clock or by chance.
inline std::vector<std::vector<std::string>> comparable_results(const std::filesystem::path& out) {
  const auto is_chance = [](std::string_view column) {
    return column.ends_with("_ms") || column == "wall_s" || column == "cpu_s" ||
           column == "peak_memory_mb" || column == "attempts" || column == "host" ||
           column == "started_utc";
  };
  files::LineReader reader(out / "results.csv");
  std::vector<std::size_t> kept;
  std::vector<std::vector<std::string>> rows;
  while (reader.next()) {
    const auto cells = files::split_cells(reader.line(), ',');
    if (rows.empty()) {
      for (std::size_t k = 0; k < cells.size(); ++k) {
        if (!is_chance(cells[k])) kept.push_back(k);
      }
    }
    std::vector<std::string>& row = rows.emplace_back();
    for (const std::size_t k : kept) row.emplace_back(cells.at(k));
  }
  return rows;
}

}  // namespace traverse::testing
