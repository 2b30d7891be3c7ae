#pragma once

#include <string_view>

/// The JavaScript libraries of the page, built into the program from Debian's packages so that a
/// report can be written anywhere.
namespace traverse::page::web {

std::string_view three();           ///< libjs-three, MIT
std::string_view orbit_controls();  ///< of the same
std::string_view dygraphs();        ///< libjs-dygraphs, MIT
std::string_view dygraphs_style();

/// As the files that were built in say themselves: "111", "2.2.1".
extern const std::string_view kThreeVersion;
extern const std::string_view kDygraphsVersion;

}  // namespace traverse::page::web
