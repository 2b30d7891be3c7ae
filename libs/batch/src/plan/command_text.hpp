#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace traverse::batch {

/// Goes through a command, piece by piece: what stands between placeholders, and the names in their
/// braces. Braces of the shell (${HOME}) and of other programs stay what they are.
void for_each_placeholder(const std::string& text,
                          const std::function<void(std::string_view plain)>& plain,
                          const std::function<void(const std::string& name)>& placeholder);

}  // namespace traverse::batch
