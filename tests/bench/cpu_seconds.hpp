#pragma once

#include <ctime>

namespace traverse::testing {

/// Of the processor: what other programs take of a shared machine does not count.
double cpu_seconds_of(const auto& action) {
  const std::clock_t begin = std::clock();
  action();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

}  // namespace traverse::testing
