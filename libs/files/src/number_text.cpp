#include "traverse/files/number_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "traverse/files/numbers.hpp"

namespace traverse::files {

namespace {

constexpr const char* kMinus = "\u2212";
constexpr const char* kThinSpace = "\u2009";
constexpr std::size_t kUngrouped = 4;  // digits that need no spaces yet

std::string with_true_minus(const std::string& text) {
  return text.starts_with('-') ? kMinus + text.substr(1) : text;
}

}  // namespace

std::string short_number(double value) {
  if (!std::isfinite(value)) return "\u2013";
  const double magnitude = std::abs(value);
  if (magnitude == 0) return "0";
  if (magnitude >= 1e6 || magnitude < 1e-4) return with_true_minus(fmt::format("{:.2e}", value));
  if (magnitude >= 100) return with_true_minus(fmt::format("{:.1f}", value));
  // Three digits from the first that is not zero.
  const int decimals = std::max(0, 2 - static_cast<int>(std::floor(std::log10(magnitude))));
  return with_true_minus(fmt::format("{:.{}f}", value, decimals));
}

std::string full_number(double value) {
  return std::isfinite(value) ? to_text(value) : "not defined";
}

std::string grouped(const std::string& digits) {
  if (digits.size() <= kUngrouped) return digits;
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += kThinSpace;
    text += digits[i];
  }
  return text;
}

std::string count_text(std::size_t count) { return grouped(std::to_string(count)); }

std::string noun(std::size_t count, std::string_view singular) {
  return std::string(singular) + (count == 1 ? "" : "s");
}

std::string plural(std::size_t count, std::string_view singular) {
  return count_text(count) + " " + noun(count, singular);
}

std::string bytes_text(double bytes) {
  static constexpr std::array<const char*, 5> kUnits{"bytes", "kB", "MB", "GB", "TB"};
  std::size_t unit = 0;
  while (bytes >= 1000 && unit + 1 < kUnits.size()) {
    bytes /= 1000;
    ++unit;
  }
  return fmt::format("{} {}", short_number(bytes), kUnits.at(unit));
}

std::string duration_text(double seconds) {
  if (seconds < 120) return fmt::format("{} s", short_number(seconds));
  const auto minutes = static_cast<long>(seconds / 60);
  if (minutes < 60)
    return fmt::format("{} min {:02.0f} s", minutes, seconds - 60.0 * static_cast<double>(minutes));
  return fmt::format("{} h {:02d} min", minutes / 60, minutes % 60);
}

std::string clock_text(double seconds, int decimals) {
  const double unit = std::pow(10, decimals);
  const double rounded = std::max(0.0, std::round(seconds * unit) / unit);
  const auto minutes = static_cast<long>(rounded / 60);
  const std::string rest = fmt::format("{:0{}.{}f}", rounded - 60.0 * static_cast<double>(minutes),
                                       decimals == 0 ? 2 : 3 + decimals, decimals);
  return minutes < 60 ? fmt::format("{}:{}", minutes, rest)
                      : fmt::format("{}:{:02d}:{}", minutes / 60, minutes % 60, rest);
}

}  // namespace traverse::files
