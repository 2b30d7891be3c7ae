#pragma once

#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <string>
#include <sys/wait.h>
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

  void signal(int number) const { ::kill(pid_, number); }
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
