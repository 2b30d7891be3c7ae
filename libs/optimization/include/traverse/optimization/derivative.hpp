#pragma once

#include <array>
#include <string_view>
#include <utility>

namespace traverse::optimization {

/// Where the Jacobians of a factor come from: formulas derived by hand, dual numbers (Ceres'
/// automatic differentiation), or central differences (Ceres' numeric differentiation).
enum class Derivative { kAnalytic, kAutomatic, kNumeric };

inline constexpr std::array<std::pair<std::string_view, Derivative>, 3> kDerivativeNames{
    {{"analytic", Derivative::kAnalytic},
     {"automatic", Derivative::kAutomatic},
     {"numeric", Derivative::kNumeric}}};
std::string_view name_of(Derivative derivative);

}  // namespace traverse::optimization
