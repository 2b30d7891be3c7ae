#pragma once

#include <string>
#include <string_view>

namespace traverse::report {

std::string base64(std::string_view bytes);

/// A file's bytes as "data:image/png;base64,...", to stand in an HTML page.
std::string data_uri(std::string_view type, std::string_view bytes);

}  // namespace traverse::report
