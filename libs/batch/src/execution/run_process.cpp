#include "execution/run_process.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <poll.h>
#include <sstream>
#include <string>
#include <string_view>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

#include <fmt/format.h>

namespace traverse::batch {

namespace {

using Clock = std::chrono::steady_clock;
using EndCause = ProcessEnd::Cause;

constexpr int kLookEvery_ms = 50;  // at the beginning more often: short runs have memory too
constexpr int kCannotStart = 127;  // as shells say it

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

/// A file descriptor that is closed with its owner.
class Descriptor {
 public:
  Descriptor(int number, const char* what) : number_(number) {
    if (number < 0) fail(what);
  }
  ~Descriptor() { ::close(number_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

/// What the new process does before it becomes the program: only calls that are safe between fork
/// and exec of a program with threads.
[[noreturn]] void become(const char* program, char* const* words, const char* folder, int log,
                         pid_t parent) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) ::signal(signal, SIG_DFL);
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(kCannotStart);  // it died before the line above
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(log, STDOUT_FILENO);
  ::dup2(log, STDERR_FILENO);
  if (::chdir(folder) == 0) ::execv(program, words);
  ::_exit(kCannotStart);
}

/// The memory that a process holds ("VmRSS"), or the most that its program ever held ("VmHWM");
/// 0 when it has ended.
double memory_mb(pid_t pid, std::string_view which) {
  std::ifstream stream(fmt::format("/proc/{}/status", pid));
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with(which)) return std::stod(line.substr(which.size() + 1)) / 1024;
  }
  return 0;
}

bool has_in_environment(pid_t pid, const std::string& mark) {
  std::ifstream stream(fmt::format("/proc/{}/environ", pid), std::ios::binary);
  for (std::string variable; std::getline(stream, variable, '\0');) {
    if (variable == mark) return true;
  }
  return false;
}

/// Processor time that a process has had, with that of its children that it waited for.
double cpu_s_of(pid_t pid) {
  std::ifstream stream(fmt::format("/proc/{}/stat", pid));
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::size_t name_ends = text.rfind(')');
  if (name_ends == std::string::npos) return 0;
  std::istringstream fields(text.substr(name_ends + 2));
  std::string skipped;
  for (int k = 0; k < 11; ++k) fields >> skipped;  // from the state to the page faults
  double ticks = 0;
  for (int k = 0; k < 4; ++k) {
    double value = 0;
    fields >> value;
    ticks += value;
  }
  return ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

/// The memory that all processes of a group hold together, and those with the mark beside it, whose
/// processor time is noted.
double group_memory_mb(pid_t group, const std::string& mark, std::map<pid_t, double>& cpu_s) {
  double sum = 0;
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator("/proc", failure)) {
    const std::string name = entry.path().filename().string();
    if (name.empty() || name.find_first_not_of("0123456789") != std::string::npos) continue;
    const auto pid = static_cast<pid_t>(std::stol(name));
    const bool is_in_group = ::getpgid(pid) == group;
    if (!is_in_group && (mark.empty() || !has_in_environment(pid, mark))) continue;
    sum += memory_mb(pid, "VmRSS:");
    if (!is_in_group) cpu_s[pid] = std::max(cpu_s[pid], cpu_s_of(pid));
  }
  return sum;
}

/// Waits until the new process, which alone holds the other end, has become its program.
void wait_for_program(int pipe) {
  char nothing = 0;
  while (::read(pipe, &nothing, 1) < 0 && errno == EINTR) continue;
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

ProcessEnd run_process(const ProcessStart& start, const std::atomic<bool>& stop) {
  const std::string program = start.program.string();
  std::vector<char*> words{const_cast<char*>(program.c_str())};
  for (const std::string& word : start.arguments) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const Descriptor log(
      ::open(start.log.c_str(),
             O_WRONLY | O_CREAT | (start.appends ? 0 : O_TRUNC) | O_APPEND | O_CLOEXEC, 0666),
      start.log.c_str());

  const auto began = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - began).count(); };
  const pid_t parent = ::getpid();
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail("a pipe");
  const Descriptor program_begins(ends[0], "a pipe");
  auto before_program = std::make_unique<Descriptor>(ends[1], "a pipe");
  const pid_t pid = ::fork();
  if (pid < 0) fail("a new process");
  if (pid == 0) {
    become(program.c_str(), words.data(), start.folder.c_str(), log.number(), parent);
  }
  ::setpgid(pid, pid);  // whoever is first
  // Not ::pidfd_open(): glibc 2.36 declares it with C++ linkage.
  const Descriptor handle(static_cast<int>(::syscall(SYS_pidfd_open, pid, 0)),
                          "watching a process");
  start.started(pid);
  before_program.reset();
  wait_for_program(program_begins.number());  // until then the memory seen is that of this process

  ProcessEnd end;
  std::map<pid_t, double> cpu_s_beside;  // of marked processes that are not in the group
  end.peak_memory_mb = memory_mb(pid, "VmHWM:");
  const auto end_it = [&](EndCause cause) {
    end.cause = cause;
    ::kill(-pid, SIGKILL);
  };
  pollfd ended{handle.number(), POLLIN, 0};
  int look_after_ms = 1;
  while (::poll(&ended, 1, look_after_ms) <= 0) {
    look_after_ms = std::min(2 * look_after_ms, kLookEvery_ms);
    if (end.cause != EndCause::kItself) continue;  // it is dying
    const double now_mb =
        start.is_group ? group_memory_mb(pid, start.mark, cpu_s_beside) : memory_mb(pid, "VmRSS:");
    end.peak_memory_mb =
        std::max(end.peak_memory_mb, start.is_group ? now_mb : memory_mb(pid, "VmHWM:"));
    if (stop) {
      end_it(EndCause::kStopped);
    } else if (start.time_limit_s > 0 && elapsed() > start.time_limit_s) {
      end_it(EndCause::kTimeLimit);
    } else if (start.memory_limit_mb > 0 && now_mb > start.memory_limit_mb) {
      end_it(EndCause::kMemoryLimit);
    }
  }
  int status = 0;
  rusage usage{};
  while (::wait4(pid, &status, 0, &usage) < 0) {
    if (errno != EINTR) fail("waiting for a process");
  }
  end.wall_s = elapsed();
  end.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  for (const auto& [beside, cpu_s] : cpu_s_beside) end.cpu_s += cpu_s;
  // The system's own figure counts what the process held before it became the program: a copy of
  // this one. Above that it is the program's, and exact; else it is a bound, if nothing was seen.
  const double counted_mb = static_cast<double>(usage.ru_maxrss) / 1024;
  const bool counted_is_programs = counted_mb > memory_mb(parent, "VmHWM:");
  // Of a group it is that of the largest process alone.
  const bool is_more = !start.is_group || counted_mb > end.peak_memory_mb;
  if ((counted_is_programs && is_more) || end.peak_memory_mb == 0) end.peak_memory_mb = counted_mb;
  if (start.is_group) ::kill(-pid, SIGKILL);
  if (WIFEXITED(status)) end.exit_status = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  if (end.cause == EndCause::kItself && start.memory_limit_mb > 0 && counted_is_programs &&
      counted_mb > start.memory_limit_mb) {
    end.cause = EndCause::kMemoryLimit;  // it came and went between two looks
  }
  return end;
}

}  // namespace traverse::batch
