#pragma once

#include <cstddef>
#include <span>

#include "simulated_places.hpp"

namespace traverse::testing {

/// Times the search for loops while the keyframes are added one by one, and prints a table: what
/// one keyframe costs when there are so many before it, and how that grows beside the logarithm of
/// their number.
/// \param sizes ascending, the last at most places.size() less the keyframes asked for at each
void print_loop_search(std::span<const SimulatedPlace> places, std::span<const std::size_t> sizes);

/// Keyframes whose search is timed at each size.
inline constexpr std::size_t kSearches = 500;

}  // namespace traverse::testing
