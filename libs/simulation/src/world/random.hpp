#pragma once

#include <cstdint>
#include <random>

namespace traverse::simulation {

/// The dice of a world's builders. Two draws in one expression have an order that each compiler
/// chooses for itself, so each draw that another one follows gets a name.
class Random {
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}

  double uniform(double least, double most) {
    return least + (most - least) * std::uniform_real_distribution<double>(0, 1)(generator_);
  }
  double gaussian() { return std::normal_distribution<double>(0, 1)(generator_); }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  /// 0 .. count - 1.
  std::size_t below(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(generator_);
  }

 private:
  std::mt19937_64 generator_;
};

}  // namespace traverse::simulation
