#pragma once

#include "traverse/files/input_error.hpp"

namespace traverse::pipeline {

/// What `read` gives of a run folder; its files::InputError tells the next step too.
template <typename Read>
auto with_next_step(const Read& read) {
  try {
    return read();
  } catch (const files::InputError& error) {
    throw files::InputError(error.file(), error.place(), error.expected(),
                            error.found() + "; `traverse run` again writes the folder anew");
  }
}

}  // namespace traverse::pipeline
