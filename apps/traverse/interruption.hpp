#pragma once

#include <atomic>
#include <functional>
#include <string>

namespace traverse::app {

/// For the whole program, called in main before any thread starts: SIGINT, SIGTERM and SIGHUP end
/// the command. Unfinished files and folders (files::Unfinished) are removed, and the exit status
/// is 128 + the signal: 130, 143, 129. A signal that was ignored when the program was started
/// (nohup, a shell's background job) stays ignored.
void end_on_signals();

/// While one lives, the first signal asks for an orderly end: `message()` goes to stderr at once
/// and requested() becomes true. A second one ends the program as end_on_signals() says. There is
/// one at a time.
///
/// A command that ended in order says so with `throw CLI::RuntimeError(stop.exit_status())`.
class OrderlyStop {
 public:
  /// \param message a line without its end; called by another thread
  explicit OrderlyStop(std::function<std::string()> message);
  ~OrderlyStop();
  OrderlyStop(const OrderlyStop&) = delete;
  OrderlyStop& operator=(const OrderlyStop&) = delete;

  const std::atomic<bool>& requested() const { return requested_; }
  /// 128 + the signal; 0 when none came.
  int exit_status() const;

 private:
  friend class SignalListener;
  std::function<std::string()> message_;
  std::atomic<bool> requested_{false};
  std::atomic<int> signal_{0};
};

/// Called before an error is told or the program returns: when a signal is just ending the program,
/// what fails meanwhile fails because of that, and this does not return.
void wait_if_ending();

}  // namespace traverse::app
