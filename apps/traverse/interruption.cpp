#include "interruption.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <mutex>
#include <poll.h>
#include <string_view>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <utility>

#include "traverse/files/unfinished.hpp"

namespace traverse::app {

namespace {

constexpr std::array kEndingSignals{SIGINT, SIGTERM, SIGHUP};
constexpr int kSignalled = 128;  // and the number of the signal, as shells count

// What the handler uses. It only passes the signal on to a thread, which may lock and allocate; and
// other than a blocked signal, a handler is not inherited by the programs that this one starts.
pid_t own_process = 0;
int to_listener = -1;

void pass_on(int signal) {
  const int error = errno;
  if (::getpid() == own_process) {
    const auto byte = static_cast<unsigned char>(signal);
    [[maybe_unused]] const ssize_t written = ::write(to_listener, &byte, 1);
  } else {  // a child that has not yet become its program
    ::signal(signal, SIG_DFL);
    ::raise(signal);
  }
  errno = error;
}

/// Works with a stderr that is closed or that nobody reads, and whatever the other threads hold.
void tell(std::string_view line) {
  pollfd taken{STDERR_FILENO, POLLOUT, 0};
  if (::poll(&taken, 1, 0) <= 0) return;
  std::string text = ::isatty(STDERR_FILENO) == 1 ? "\n" : "";  // the cursor is behind a "^C"
  text += "traverse: ";
  text += line;
  text += "\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
}

std::atomic<bool> is_ending{false};

}  // namespace

/// The thread that does what signals ask for.
class SignalListener {
 public:
  static SignalListener& instance() {
    static auto& listener = *new SignalListener;  // never destroyed: its thread outlives main
    return listener;
  }

  void start() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) return;
    ::fcntl(ends[1], F_SETFL, O_NONBLOCK);
    own_process = ::getpid();
    to_listener = ends[1];
    try {
      std::thread([this, from = ends[0]] { listen(from); }).detach();
    } catch (const std::system_error&) {
      return;  // no thread to be had: signals end the program as they do by themselves
    }
    for (const int signal : kEndingSignals) {
      struct sigaction action {};
      ::sigaction(signal, nullptr, &action);
      if (action.sa_handler == SIG_IGN) continue;
      action.sa_handler = pass_on;
      action.sa_flags = SA_RESTART;
      ::sigaction(signal, &action, nullptr);
    }
  }

  /// \returns who was asked before
  OrderlyStop* ask_first(OrderlyStop* stop) {
    const std::lock_guard lock(mutex_);
    return std::exchange(stop_, stop);
  }

 private:
  [[noreturn]] void listen(int from) {
    for (;;) {
      unsigned char signal = 0;
      if (::read(from, &signal, 1) == 1 && !asks_for_orderly_end(signal)) end(signal);
    }
  }

  bool asks_for_orderly_end(int signal) {
    const std::lock_guard lock(mutex_);
    if (stop_ == nullptr || stop_->requested_) return false;
    stop_->signal_ = signal;
    stop_->requested_ = true;
    tell(stop_->message_());
    return true;
  }

  [[noreturn]] static void end(int signal) {
    for (const int another : kEndingSignals) {  // if it takes too long for the user
      struct sigaction action {};
      ::sigaction(another, nullptr, &action);
      if (action.sa_handler == pass_on) ::signal(another, SIG_DFL);
    }
    is_ending = true;
    tell("interrupted; what is not finished is removed");
    files::remove_unfinished();
    ::_exit(kSignalled + signal);
  }

  std::mutex mutex_;
  OrderlyStop* stop_ = nullptr;
};

void end_on_signals() { SignalListener::instance().start(); }

OrderlyStop::OrderlyStop(std::function<std::string()> message) : message_(std::move(message)) {
  SignalListener::instance().ask_first(this);
}

OrderlyStop::~OrderlyStop() { SignalListener::instance().ask_first(nullptr); }

int OrderlyStop::exit_status() const {
  const int signal = signal_;
  return signal == 0 ? 0 : kSignalled + signal;
}

void wait_if_ending() {
  while (is_ending) ::pause();
}

}  // namespace traverse::app
