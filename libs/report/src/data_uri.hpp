#pragma once

#include <string>
#include <string_view>

namespace traverse::report {

std::string base64(std::string_view bytes);

/// A PNG file's bytes as "data:image/png;base64,...", to stand in an HTML page.
std::string png_data_uri(std::string_view png);

}  // namespace traverse::report
