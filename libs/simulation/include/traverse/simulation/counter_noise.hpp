#pragma once

#include <cstdint>

namespace traverse::simulation {

/// Random numbers by place instead of by turn: the same for the same seed, stream and counters, in
/// whatever order and thread they are asked for. Source: Salmon et al., "Parallel random numbers:
/// as easy as 1, 2, 3", SC 2011 (Philox 4x32).
class CounterNoise {
 public:
  /// `stream` tells sensors apart.
  CounterNoise(std::uint64_t seed, std::uint32_t stream) : seed_(seed), stream_(stream) {}

  struct Draw {
    double gaussian_1, gaussian_2;  ///< independent, mean 0, standard deviation 1
    double uniform_1, uniform_2;    ///< between 0 and 1
  };
  Draw at(std::uint64_t major, std::uint32_t minor = 0) const;

 private:
  std::uint64_t seed_;
  std::uint32_t stream_;
};

}  // namespace traverse::simulation
