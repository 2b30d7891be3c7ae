#include "wander.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace traverse::simulation {

namespace {

constexpr double kShortest = 60;  ///< metres, of the waves: nobody swerves within a few lengths
constexpr double kLongest = 300;
constexpr double kTurn = 2 * std::numbers::pi;

}  // namespace

Wander::Wander(double length_m, double max_m, std::uint64_t seed)
    : amplitude_m_(max_m / static_cast<double>(waves_.size())) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> share(0, 1);
  for (Wave& wave : waves_) {
    const double wavelength_m = kShortest * std::pow(kLongest / kShortest, share(generator));
    const double turns = std::max(1.0, std::round(length_m / wavelength_m));
    wave = {kTurn * turns / length_m, kTurn * share(generator)};
  }
}

double Wander::left_m(double s) const {
  double sum = 0;
  for (const Wave& wave : waves_) sum += std::sin(wave.per_m * s + wave.phase);
  return amplitude_m_ * sum;
}

}  // namespace traverse::simulation
