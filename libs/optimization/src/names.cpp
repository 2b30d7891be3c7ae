#include "traverse/optimization/derivative.hpp"
#include "traverse/optimization/perturbation.hpp"
#include "traverse/optimization/termination.hpp"

namespace traverse::optimization {

namespace {

template <typename Names, typename Enum>
std::string_view name_in(const Names& names, Enum value) {
  for (const auto& [name, named] : names) {
    if (named == value) return name;
  }
  return "";
}

}  // namespace

std::string_view name_of(Perturbation perturbation) {
  return name_in(kPerturbationNames, perturbation);
}

std::string_view name_of(Derivative derivative) { return name_in(kDerivativeNames, derivative); }

std::string_view name_of(Termination termination) {
  return name_in(kTerminationNames, termination);
}

}  // namespace traverse::optimization
