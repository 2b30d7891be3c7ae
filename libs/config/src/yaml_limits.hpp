#pragma once

#include <string>

namespace traverse::config {

/// Looks at all of `yaml` before anything is made of it.
/// \throws files::InputError with the line if it is no YAML, nests its values too deep, has too
/// many of them or too long ones, each counted as often as an alias repeats it, or refers to a
/// value from within.
void check_yaml(const std::string& yaml, const std::string& origin);

}  // namespace traverse::config
