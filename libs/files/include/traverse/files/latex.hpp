#pragma once

#include <string>
#include <string_view>

namespace traverse::files {

/// `text` as LaTeX prints it: what LaTeX would take for itself is escaped, line breaks are blanks.
/// reports/templates/page.js does the same in the page.
std::string latex_text(std::string_view text);

}  // namespace traverse::files
