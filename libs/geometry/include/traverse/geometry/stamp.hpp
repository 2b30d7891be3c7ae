#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace traverse::geometry {

/// A moment: whole nanoseconds since the recording's epoch (Unix time where the recording has it).
/// An integer, because a double holds today's Unix time only to 0.24 microseconds and order and
/// equality of stamps matter.
struct Stamp {
  std::int64_t nanoseconds = 0;

  static Stamp from_seconds(double seconds);  ///< nearest, to 9.2e9 s at most; of NaN the epoch
  double seconds() const { return static_cast<double>(nanoseconds) * 1e-9; }

  auto operator<=>(const Stamp&) const = default;
};

/// later - earlier in seconds, without the loss that two doubles of Unix time would bring.
double seconds_between(Stamp earlier, Stamp later);

/// `stamp` moved by `seconds`, which may be negative, but not out of what 64 bits hold.
Stamp shifted(Stamp stamp, double seconds);

/// Seconds as a decimal with nine places: "1317042145.964000000".
std::string to_text(Stamp stamp);

/// `stamp` as a double of seconds, the nearest one: what reading to_text() of it as a number gives.
double nearest_seconds(Stamp stamp);

/// Seconds in decimal ("1317042145.964", "12", "1.5e9"), exact to the nanosecond, to which further
/// digits are rounded. Nothing if `text` is not a number or out of range.
std::optional<Stamp> parse_stamp_seconds(std::string_view text);

/// Whole nanoseconds in decimal: "1317042145964000000", also as programs write them that took them
/// for floating-point numbers ("1.317042145964000000e+18"). Nothing if a fraction is left.
std::optional<Stamp> parse_stamp_nanoseconds(std::string_view text);

/// What a time that is given without a unit means if it is a Unix time between 1973 and 2261, told
/// by its size.
enum class UnixTimeUnit { kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };
/// Nothing below 1e8 and from 9.2e18 on.
std::optional<UnixTimeUnit> unix_time_unit(double time);
/// `text` as a decimal number of that unit, exact to the nanosecond; nothing if it is none or out
/// of range.
std::optional<Stamp> parse_unix_time(std::string_view text, UnixTimeUnit unit);
/// "nanoseconds"
std::string_view name_of(UnixTimeUnit unit);
/// 1e-9
double seconds_of(UnixTimeUnit unit);

}  // namespace traverse::geometry
