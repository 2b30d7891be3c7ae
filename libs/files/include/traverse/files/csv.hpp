#pragma once

#include <string>
#include <string_view>

namespace traverse::files {

/// `text` as a cell of a CSV file: in quotes where it holds a comma, a quote or a line break (RFC
/// 4180). What a spreadsheet would compute, a text that begins with = + - @, a tab or a line break
/// and is no number, gets an apostrophe before it, which spreadsheets take for "this is text".
/// reports/templates/page.js does the same in the page.
std::string csv_cell(std::string_view text);

}  // namespace traverse::files
