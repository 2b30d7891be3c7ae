#include "standard_streams.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <iostream>
#include <poll.h>
#include <unistd.h>

#include "traverse/files/input_error.hpp"

namespace traverse::app {

namespace {

bool is_closed(int descriptor) { return ::fcntl(descriptor, F_GETFD) < 0 && errno == EBADF; }

bool has_lost_its_reader(int descriptor) {
  pollfd pipe{descriptor, POLLOUT, 0};
  return ::poll(&pipe, 1, 0) > 0 && (pipe.revents & POLLERR) != 0;
}

}  // namespace

void prepare_standard_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // The lowest free number is given, and those below are open by now.
    if (is_closed(descriptor)) [[maybe_unused]]
      const int same = ::open("/dev/null", O_RDWR);
  }
  std::signal(SIGPIPE, SIG_IGN);
}

void print_message(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

void print_notes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) print_message("note: {}\n", note);
}

void require_printed() {
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0;
  const int error = errno;
  std::cout.flush();
  if (flushed && std::ferror(stdout) == 0) return;
  if (has_lost_its_reader(STDOUT_FILENO)) {
    std::signal(SIGPIPE, SIG_DFL);
    ::raise(SIGPIPE);
  }
  throw files::OutputError("standard output", error == 0
                                                  ? "not every byte was taken (is the disk full?)"
                                                  : std::strerror(error));
}

}  // namespace traverse::app
