#pragma once

#include <string>

#include "traverse/files/number_text.hpp"

namespace traverse::render {

/// `value` with `decimals` places, a true minus sign and thin spaces between thousands from five
/// digits on: "−0.50", "12 000". A value that is not finite is "–".
std::string fixed_text(double value, int decimals);

/// `value` with `digits` significant digits, without a power of ten between 1e-4 and 1e7:
/// "0.184", "12.3", "1 230 000", "2.5·10⁻⁶".
std::string value_text(double value, int digits = 3);

using files::count_text;

/// "10⁻³".
std::string power_of_ten_text(int exponent);

}  // namespace traverse::render
