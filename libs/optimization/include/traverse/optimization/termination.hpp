#pragma once

#include <array>
#include <string_view>
#include <utility>

namespace traverse::optimization {

/// Why a solver ended: one list for the pose graph, the registrations of lidar scans and the
/// fixed-lag smoother.
enum class Termination {
  kNotRun,          ///< nothing was asked for: the first frame, which defines the map
  kConverged,       ///< the last step, or what it changed, is below the solver's tolerance
  kIterationLimit,  ///< the steps were used up; the result may still be good
  kTooFewMatches,   ///< there is not enough to solve with: the start stands
  kNotSolvable      ///< the equations could not be evaluated or solved: the start stands
};

inline constexpr std::array<std::pair<std::string_view, Termination>, 5> kTerminationNames{
    {{"not run", Termination::kNotRun},
     {"converged", Termination::kConverged},
     {"iteration limit", Termination::kIterationLimit},
     {"too few matches", Termination::kTooFewMatches},
     {"not solvable", Termination::kNotSolvable}}};
std::string_view name_of(Termination termination);

}  // namespace traverse::optimization
