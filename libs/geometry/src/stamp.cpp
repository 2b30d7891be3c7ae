#include "traverse/geometry/stamp.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <system_error>

#include <fmt/format.h>

namespace traverse::geometry {

namespace {

constexpr std::int64_t kPerSecond = 1'000'000'000;
constexpr double kLargestSeconds = 9.2e9;  // of what 64 bits hold, the year 2261
constexpr std::int64_t kFarthest = 9'200'000'000 * kPerSecond;

/// A number in decimal, its digits one after the other without a point.
struct Decimal {
  bool is_negative = false;
  std::string_view whole;
  std::string_view decimals;
  std::int64_t exponent = 0;  ///< of ten, that the number is to be multiplied by
};

bool are_digits(std::string_view text) {
  return text.find_first_not_of("0123456789") == std::string_view::npos;
}

std::optional<Decimal> parse_decimal(std::string_view text) {
  Decimal number;
  number.is_negative = text.starts_with('-');
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  if (const std::size_t e = text.find_first_of("eE"); e != std::string_view::npos) {
    std::string_view exponent = text.substr(e + 1);
    if (exponent.starts_with('+')) exponent.remove_prefix(1);
    const char* const past = exponent.data() + exponent.size();
    const auto [end, error] = std::from_chars(exponent.data(), past, number.exponent);
    constexpr std::int64_t kFar = 1'000'000;  // so far from any time, and sums of it still fit
    if (error != std::errc{} || end != past || std::abs(number.exponent) > kFar) {
      return std::nullopt;
    }
    text = text.substr(0, e);
  }
  const std::size_t point = std::min(text.find('.'), text.size());
  number.whole = text.substr(0, point);
  if (point < text.size()) number.decimals = text.substr(point + 1);
  if (number.whole.empty() && number.decimals.empty()) return std::nullopt;
  if (!are_digits(number.whole) || !are_digits(number.decimals)) return std::nullopt;
  return number;
}

/// Whether a digit other than 0 stands behind the point.
bool has_fraction(const Decimal& number) {
  const auto whole = static_cast<std::int64_t>(number.whole.size());
  const std::int64_t point = whole + number.exponent;
  const auto is_zero = [](std::string_view digits) {
    return digits.find_first_not_of('0') == std::string_view::npos;
  };
  if (point >= whole) {
    const auto in_decimals = static_cast<std::size_t>(point - whole);
    return in_decimals < number.decimals.size() && !is_zero(number.decimals.substr(in_decimals));
  }
  const auto in_whole = static_cast<std::size_t>(std::max<std::int64_t>(point, 0));
  return !is_zero(number.whole.substr(in_whole)) || !is_zero(number.decimals);
}

/// `text` times ten to the power of `shift` as whole nanoseconds, rounded half away from zero.
std::optional<Stamp> parse_shifted(std::string_view text, std::int64_t shift) {
  const auto number = parse_decimal(text);
  if (!number) return std::nullopt;
  const auto whole = static_cast<std::int64_t>(number->whole.size());
  const auto digits = whole + static_cast<std::int64_t>(number->decimals.size());
  const auto digit = [&](std::int64_t i) -> std::int64_t {
    if (i < 0 || i >= digits) return 0;
    return (i < whole ? number->whole[static_cast<std::size_t>(i)]
                      : number->decimals[static_cast<std::size_t>(i - whole)]) -
           '0';
  };
  const std::int64_t wanted = whole + number->exponent + shift;  // digits before the new point
  std::int64_t first = 0;
  while (first < digits && digit(first) == 0) ++first;
  if (first == digits) return Stamp{0};
  constexpr std::int64_t kDigits = 19;  // of the largest
  if (wanted - first > kDigits) return std::nullopt;
  std::uint64_t nanoseconds = 0;
  for (std::int64_t i = first; i < wanted; ++i) {
    nanoseconds = nanoseconds * 10 + static_cast<std::uint64_t>(digit(i));
  }
  if (digit(wanted) >= 5) ++nanoseconds;
  if (nanoseconds >= static_cast<std::uint64_t>(kFarthest)) return std::nullopt;
  const auto value = static_cast<std::int64_t>(nanoseconds);
  return Stamp{number->is_negative ? -value : value};
}

}  // namespace

Stamp Stamp::from_seconds(double seconds) {
  if (std::isnan(seconds)) return {};
  if (seconds >= kLargestSeconds) return {kFarthest};
  if (seconds <= -kLargestSeconds) return {-kFarthest};
  // Whole seconds apart, so that the product with 1e9 does not lose the last digits.
  const double whole = std::floor(seconds);
  return {static_cast<std::int64_t>(whole) * kPerSecond +
          static_cast<std::int64_t>(std::llround((seconds - whole) * 1e9))};
}

double seconds_between(Stamp earlier, Stamp later) {
  std::int64_t nanoseconds = 0;
  if (__builtin_sub_overflow(later.nanoseconds, earlier.nanoseconds, &nanoseconds)) {
    return later.seconds() - earlier.seconds();  // centuries apart: damaged stamps
  }
  return static_cast<double>(nanoseconds) * 1e-9;
}

Stamp shifted(Stamp stamp, double seconds) {
  if (std::isnan(seconds)) return stamp;
  const std::int64_t farthest = std::signbit(seconds) ? -kFarthest : kFarthest;
  if (std::abs(seconds) >= kLargestSeconds) return {farthest};
  const auto by = static_cast<std::int64_t>(std::llround(seconds * 1e9));
  std::int64_t nanoseconds = 0;
  if (__builtin_add_overflow(stamp.nanoseconds, by, &nanoseconds)) return {farthest};
  return {nanoseconds};
}

std::string to_text(Stamp stamp) {
  const bool negative = stamp.nanoseconds < 0;
  // Unsigned, because the least of 64 bits has no opposite.
  const auto bits = static_cast<std::uint64_t>(stamp.nanoseconds);
  const std::uint64_t magnitude = negative ? std::uint64_t{0} - bits : bits;
  return fmt::format("{}{}.{:09d}", negative ? "-" : "", magnitude / std::uint64_t{kPerSecond},
                     magnitude % std::uint64_t{kPerSecond});
}

double nearest_seconds(Stamp stamp) {
  // Rounded to a long double and again to a double: only half way between two may that go wrong.
  const long double wide = static_cast<long double>(stamp.nanoseconds) / 1e9L;
  const auto near = static_cast<double>(wide);
  const double next = std::nextafter(near, wide > near ? std::numeric_limits<double>::infinity()
                                                       : -std::numeric_limits<double>::infinity());
  if (std::abs(wide - near) != std::abs(static_cast<long double>(next) - wide)) return near;
  const std::string text = to_text(stamp);
  double seconds = 0;
  std::from_chars(text.data(), text.data() + text.size(), seconds);
  return seconds;
}

std::optional<Stamp> parse_stamp_seconds(std::string_view text) { return parse_shifted(text, 9); }

std::optional<Stamp> parse_stamp_nanoseconds(std::string_view text) {
  std::int64_t whole = 0;  // by far the usual form, and with all that 64 bits hold
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), whole);
  if (error == std::errc{} && end == text.data() + text.size()) return Stamp{whole};
  const auto number = parse_decimal(text);
  if (!number || has_fraction(*number)) return std::nullopt;
  return parse_shifted(text, 0);
}

std::optional<UnixTimeUnit> unix_time_unit(double time) {
  constexpr double kLeast = 1e8;    // seconds: the year 1973
  constexpr double kMost = 9.2e18;  // nanoseconds: the year 2261
  const double size = std::abs(time);
  if (!(size >= kLeast && size < kMost)) return std::nullopt;
  if (size < 1e11) return UnixTimeUnit::kSeconds;
  if (size < 1e14) return UnixTimeUnit::kMilliseconds;
  if (size < 1e17) return UnixTimeUnit::kMicroseconds;
  return UnixTimeUnit::kNanoseconds;
}

std::optional<Stamp> parse_unix_time(std::string_view text, UnixTimeUnit unit) {
  return parse_shifted(text, 9 - 3 * static_cast<std::int64_t>(unit));
}

std::string_view name_of(UnixTimeUnit unit) {
  switch (unit) {
    case UnixTimeUnit::kSeconds:
      return "seconds";
    case UnixTimeUnit::kMilliseconds:
      return "milliseconds";
    case UnixTimeUnit::kMicroseconds:
      return "microseconds";
    case UnixTimeUnit::kNanoseconds:
      return "nanoseconds";
  }
  return "seconds";
}

double seconds_of(UnixTimeUnit unit) {
  switch (unit) {
    case UnixTimeUnit::kSeconds:
      return 1;
    case UnixTimeUnit::kMilliseconds:
      return 1e-3;
    case UnixTimeUnit::kMicroseconds:
      return 1e-6;
    case UnixTimeUnit::kNanoseconds:
      return 1e-9;
  }
  return 1;
}

}  // namespace traverse::geometry
