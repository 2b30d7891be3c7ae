#pragma once

#include <string_view>

/// The JavaScript libraries of the page, built into the program from Debian's packages so that a
/// report can be written anywhere.
namespace traverse::report::web {

std::string_view three();           ///< libjs-three r111, MIT
std::string_view orbit_controls();  ///< of the same
std::string_view dygraphs();        ///< libjs-dygraphs 2.2.1, MIT
std::string_view dygraphs_style();

}  // namespace traverse::report::web
