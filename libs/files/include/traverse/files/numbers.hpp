#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace traverse::files {

/// The whole of `text` as a number, independent of the locale ("1e-3", "-2.5", "nan", "inf").
/// Nothing when any character is left over.
std::optional<double> parse_double(std::string_view text);

/// The whole of `text` as a decimal integer.
std::optional<std::int64_t> parse_integer(std::string_view text);

/// `value` with 17 significant digits or fewer where fewer say the same: parse_double() of the
/// result is `value` again, bit for bit.
std::string to_text(double value);

/// The words of `line`, separated by blanks and tabs; of more than `most` the first `most`.
std::vector<std::string_view> split_words(std::string_view line,
                                          std::size_t most = static_cast<std::size_t>(-1));

/// The cells of `line` between `separator`s, without the blanks around each.
std::vector<std::string_view> split_cells(std::string_view line, char separator);

}  // namespace traverse::files
