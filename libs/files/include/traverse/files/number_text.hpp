#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Numbers as people read them: on pages, below pictures, in messages.
namespace traverse::files {

/// Three or four significant digits, no exponent where a person would not write one, a true minus
/// sign; "–" for what is not finite. reports/templates/page.js does the same in the page.
std::string short_number(double value);

/// All digits, for a tooltip: reads back to the same bits.
std::string full_number(double value);

/// Digits with thin spaces between thousands from five on: "1234", "12 345".
std::string grouped(const std::string& digits);
std::string count_text(std::size_t count);  ///< a whole number so

/// The noun for so many: "frame", "frames".
std::string noun(std::size_t count, std::string_view singular);

/// "1 frame", "12 345 frames".
std::string plural(std::size_t count, std::string_view singular);

/// Bytes as "211 MB".
std::string bytes_text(double bytes);

/// Seconds as "43.2 s" or "1 h 02 min".
std::string duration_text(double seconds);

/// Seconds as a clock shows them, "0:03", "1:02:30"; with `decimals` of the second, "0:03.25".
std::string clock_text(double seconds, int decimals = 0);

}  // namespace traverse::files
