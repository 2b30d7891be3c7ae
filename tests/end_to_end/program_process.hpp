#pragma once

#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace traverse::testing {

/// `traverse WORDS` in a process that the test can send signals to.
class ProgramProcess {
 public:
  /// \param log takes what it prints and its messages
  ProgramProcess(const std::vector<std::string>& words, const std::filesystem::path& log) {
    std::vector<char*> arguments{const_cast<char*>("traverse")};
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ != 0) return;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::signal(signal, SIG_DFL);
    const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    ::dup2(file, STDOUT_FILENO);
    ::dup2(file, STDERR_FILENO);
    ::execv(TRAVERSE_PROGRAM, arguments.data());
    ::_exit(127);
  }
  ~ProgramProcess() {
    if (ended_) return;
    signal(SIGKILL);
    wait();
  }
  ProgramProcess(const ProgramProcess&) = delete;
  ProgramProcess& operator=(const ProgramProcess&) = delete;

  /// Waits until the program has said what its signals do: before, they end it as any process.
  void wait_for_handlers() const {
    const std::string status = "/proc/" + std::to_string(pid_) + "/status";
    for (int look = 0; look < 10000; ++look) {
      std::ifstream stream(status);
      for (std::string line; std::getline(stream, line);) {
        if (line.starts_with("State:") && line.find('Z') != std::string::npos) return;
        if (!line.starts_with("SigCgt:")) continue;
        const unsigned long caught =
            std::stoul(line.substr(line.find_first_not_of(" \t", 7)), nullptr, 16);
        if ((caught & (1UL << (SIGTERM - 1))) != 0) return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  void signal(int number) const { ::kill(pid_, number); }
  /// Whether it has ended by itself; wait() tells how.
  bool has_ended() const {
    siginfo_t info{};
    return ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == pid_;
  }
  /// \returns the exit status, or -1 if a signal ended it.
  int wait() {
    int status = 0;
    ended_ = ::waitpid(pid_, &status, 0) == pid_;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = 0;
  bool ended_ = false;
};

}  // namespace traverse::testing
