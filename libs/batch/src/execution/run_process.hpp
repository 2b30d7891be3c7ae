#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace traverse::batch {

/// A program to start in a process of its own.
struct ProcessStart {
  std::filesystem::path program;
  std::vector<std::string> arguments;  ///< without the program's name
  std::filesystem::path folder;        ///< to work in
  std::filesystem::path log;           ///< takes its standard output and its messages
  double time_limit_s = 0;             ///< 0: none
  double memory_limit_mb = 0;          ///< resident; 0: none
  bool appends = false;                ///< to the log, which is begun anew otherwise
  /// Its memory is that of all processes of its group together, and nothing of the group outlives
  /// it: of programs that start others.
  bool is_group = false;
  /// Of a group: an environment variable, as NAME=VALUE, whose processes belong to it wherever they
  /// are, as those of a container do. Their processor time is that seen last, twenty times a
  /// second.
  std::string mark = {};
  std::function<void(int pid)> started = [](int) {};
};

/// How a process ended and what it took.
struct ProcessEnd {
  enum class Cause { kItself, kTimeLimit, kMemoryLimit, kStopped };
  Cause cause = Cause::kItself;
  int exit_status = 0;
  int signal = 0;  ///< that ended it, or 0
  double wall_s = 0;
  double cpu_s = 0;
  double peak_memory_mb = 0;
};

/// Starts the program and waits for its end. It has its own process group, so that a Ctrl-C in the
/// terminal is the caller's to handle, leaves no core file, and dies with the thread that called.
///
/// The memory limit is kept by looking at the resident size twenty times a second, and once more at
/// the end by the largest size the system noted: RLIMIT_AS counts what is mapped and never touched,
/// of which a run has several times what it uses.
/// \param stop ends the process when it becomes true
/// \throws std::system_error if no process can be started.
ProcessEnd run_process(const ProcessStart& start, const std::atomic<bool>& stop);

}  // namespace traverse::batch
