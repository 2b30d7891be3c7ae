#include "plot/number_text.hpp"

#include <array>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

namespace traverse::render {

namespace {

constexpr const char* kMinus = "−";
constexpr const char* kNoNumber = "–";
/// Decimals that show `digits` significant digits of `value`.
int decimals_for(double value, int digits) {
  if (value == 0) return 0;
  const int magnitude = static_cast<int>(std::floor(std::log10(std::abs(value))));
  const int decimals = digits - 1 - magnitude;
  // 9.996 with three digits is 10.0, not 10.00.
  const double rounded = std::abs(value) * std::pow(10, decimals);
  return std::round(rounded) >= std::pow(10, digits) ? decimals - 1 : decimals;
}

}  // namespace

std::string fixed_text(double value, int decimals) {
  if (!std::isfinite(value)) return kNoNumber;
  const std::string text = fmt::format("{:.{}f}", std::abs(value), decimals);
  const std::size_t point = text.find('.');
  const bool is_zero = text.find_first_not_of("0.") == std::string::npos;
  return (value < 0 && !is_zero ? kMinus : "") + files::grouped(text.substr(0, point)) +
         (point == std::string::npos ? "" : text.substr(point));
}

std::string value_text(double value, int digits) {
  if (!std::isfinite(value)) return kNoNumber;
  const double size = std::abs(value);
  if (value != 0 && (size < 1e-4 || size >= 1e7)) {
    const int exponent = static_cast<int>(std::floor(std::log10(size)));
    return fixed_text(value / std::pow(10, exponent), digits - 1) + "·" +
           power_of_ten_text(exponent);
  }
  const int decimals = decimals_for(value, digits);
  if (decimals >= 0) return fixed_text(value, decimals);
  const double unit = std::pow(10, -decimals);
  return fixed_text(std::round(value / unit) * unit, 0);
}

std::string power_of_ten_text(int exponent) {
  constexpr std::array<const char*, 10> kSuperscripts{"⁰", "¹", "²", "³", "⁴",
                                                      "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (const char digit : std::to_string(std::abs(exponent))) {
    text += kSuperscripts.at(static_cast<std::size_t>(digit - '0'));
  }
  return text;
}

}  // namespace traverse::render
