#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <sys/wait.h>

#include "traverse/files/text_file.hpp"

#include "temporary_folder.hpp"

namespace traverse::testing {

/// What a run of the program gave.
struct ProgramResult {
  int status = -1;
  std::string output;
  std::string messages;  ///< of stderr

  std::string everything() const { return output + messages; }
};

/// Runs `traverse ARGUMENTS`, or another program, in a shell.
inline ProgramResult run_program(const std::string& arguments,
                                 const std::string& program = TRAVERSE_PROGRAM) {
  const TemporaryFolder folder;
  const std::string command = program + " " + arguments + " > '" + (folder / "out").string() +
                              "' 2> '" + (folder / "err").string() + "'";
  ProgramResult result;
  const int status = std::system(command.c_str());
  if (WIFEXITED(status)) result.status = WEXITSTATUS(status);
  result.output = files::read_text(folder / "out");
  result.messages = files::read_text(folder / "err");
  return result;
}

}  // namespace traverse::testing
