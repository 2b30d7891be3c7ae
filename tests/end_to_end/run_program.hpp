#pragma once

#include <array>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <sys/wait.h>

namespace traverse::testing {

/// What a finished program left.
struct Outcome {
  int status = 0;      ///< exit status
  std::string output;  ///< stdout and stderr, as they came
};

/// Runs the command line program with `arguments`, as a shell would take them.
inline Outcome run_traverse(const std::string& arguments) {
  const std::string command = std::string(TRAVERSE_PROGRAM) + " " + arguments + " 2>&1";
  FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot start " + command);
  Outcome outcome;
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    outcome.output.append(buffer.data(), n);
  }
  const int status = ::pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

}  // namespace traverse::testing
