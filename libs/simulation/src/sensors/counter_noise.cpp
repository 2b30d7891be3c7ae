#include "traverse/simulation/counter_noise.hpp"

#include <Random123/philox.h>
#include <cmath>
#include <numbers>

namespace traverse::simulation {

namespace {

/// Never 0 or 1.
double uniform(std::uint32_t word) { return (word + 0.5) / 4294967296.0; }

}  // namespace

CounterNoise::Draw CounterNoise::at(std::uint64_t major, std::uint32_t minor) const {
  const r123::Philox4x32::ctr_type counter{{static_cast<std::uint32_t>(major),
                                            static_cast<std::uint32_t>(major >> 32U), minor,
                                            stream_}};
  const r123::Philox4x32::key_type key{
      {static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32U)}};
  const auto words = r123::Philox4x32()(counter, key);
  // Box and Muller, "A note on the generation of random normal deviates", 1958.
  const double radius = std::sqrt(-2 * std::log(uniform(words[0])));
  const double angle = 2 * std::numbers::pi * uniform(words[1]);
  return {radius * std::cos(angle), radius * std::sin(angle), uniform(words[2]), uniform(words[3])};
}

}  // namespace traverse::simulation
