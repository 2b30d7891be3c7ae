#pragma once

#include <string>

namespace traverse::files {

/// The text in quotes that /bin/sh takes as it stands, as one word.
std::string in_shell_quotes(const std::string& text);

}  // namespace traverse::files
