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

/// Seconds in decimal ("1317042145.964", "12", "1.5e9"). Up to nine decimals are taken exactly;
/// further digits are rounded. Nothing if `text` is not a number or out of range.
std::optional<Stamp> parse_stamp_seconds(std::string_view text);

}  // namespace traverse::geometry
