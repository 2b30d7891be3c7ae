#pragma once

#include <array>
#include <cstdint>

namespace traverse::simulation {

/// How far beside the line of its lane a driver keeps, along the way: a few waves that fit into the
/// length, so that a closed route has no step where its laps meet.
class Wander {
 public:
  /// \param max_m the farthest to either side
  Wander(double length_m, double max_m, std::uint64_t seed);

  /// Metres to the left at `s` metres along.
  double left_m(double s) const;

 private:
  struct Wave {
    double per_m, phase;  // rad
  };
  std::array<Wave, 3> waves_{};
  double amplitude_m_;
};

}  // namespace traverse::simulation
