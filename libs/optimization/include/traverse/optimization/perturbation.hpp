#pragma once

#include <array>
#include <string_view>
#include <utility>

namespace traverse::optimization {

/// The side on which a small rotation vector d moves a rotation: R Exp(d), in the axes of the body,
/// or Exp(d) R, in the axes of the map. Traverse's own is the right one; published systems use
/// both.
enum class Perturbation { kRight, kLeft };

inline constexpr std::array<std::pair<std::string_view, Perturbation>, 2> kPerturbationNames{
    {{"right", Perturbation::kRight}, {"left", Perturbation::kLeft}}};
std::string_view name_of(Perturbation perturbation);

}  // namespace traverse::optimization
