#pragma once

#include <cstddef>
#include <string>

namespace traverse::report {

/// A number as the page shows it: three or four significant digits, no exponent where a person
/// would not write one, a true minus sign; "–" for what is not finite.
std::string short_number(double value);

/// All digits of the number, for the tooltip: reads back to the same bits.
std::string full_number(double value);

/// 1234567 as "1 234 567", with thin spaces.
std::string count_text(std::size_t count);

/// "1 frame", "12 345 frames".
std::string plural(std::size_t count, const std::string& noun);

/// Bytes as "211 MB".
std::string bytes_text(double bytes);

/// Seconds as "43.2 s" or "1 h 02 min".
std::string duration_text(double seconds);

}  // namespace traverse::report
