#include "traverse/geometry/stamp.hpp"

#include <charconv>
#include <cmath>
#include <system_error>

#include <fmt/format.h>

namespace traverse::geometry {

namespace {

constexpr std::int64_t kPerSecond = 1'000'000'000;
constexpr double kLargestSeconds = 9.2e9;  // of what 64 bits hold, the year 2261
constexpr std::int64_t kFarthest = 9'200'000'000 * kPerSecond;

std::optional<Stamp> parse_as_double(std::string_view text) {
  double seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  if (!(std::abs(seconds) < kLargestSeconds)) return std::nullopt;
  return Stamp::from_seconds(seconds);
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

std::optional<Stamp> parse_stamp_seconds(std::string_view text) {
  const std::string_view whole_text = text;
  const bool negative = !text.empty() && text.front() == '-';
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);

  const std::size_t point = text.find('.');
  const std::string_view whole = text.substr(0, point);
  const std::string_view decimals =
      point == std::string_view::npos ? std::string_view{} : text.substr(point + 1);
  const bool plain = !whole.empty() && whole.size() <= 10 && decimals.size() <= 9 &&
                     whole.find_first_not_of("0123456789") == std::string_view::npos &&
                     decimals.find_first_not_of("0123456789") == std::string_view::npos;
  if (!plain) return parse_as_double(whole_text);

  std::int64_t nanoseconds = 0;
  for (const char digit : whole) nanoseconds = nanoseconds * 10 + (digit - '0');
  if (static_cast<double>(nanoseconds) >= kLargestSeconds) return std::nullopt;
  for (std::size_t i = 0; i < 9; ++i) {
    nanoseconds = nanoseconds * 10 + (i < decimals.size() ? decimals[i] - '0' : 0);
  }
  return Stamp{negative ? -nanoseconds : nanoseconds};
}

}  // namespace traverse::geometry
