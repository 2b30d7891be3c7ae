#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "comparison/motion_sources.hpp"

namespace traverse::plausibility {

/// What one stream says of a piece of time.
struct TimedPiece {
  double t0 = 0;
  double t1 = 0;
  double value = 0;
};

/// How far two streams are apart.
struct Misfit {
  double mean = 0;  ///< of |difference| after the best scale and bias, as a share of |value|
  std::size_t pieces = 0;
};

/// How late one stream is against another: what it says of a moment the other said so much before.
struct Delay {
  double seconds = 0;  ///< at which they agree best
  Misfit there;
  Misfit at_zero;
  double gain_sigmas = 0;  ///< by which they agree better there, piece by piece

  /// They agree better there by three tenths and by four standard errors, or by three quarters and
  /// two standard errors, and it is farther away than `min_s`.
  bool is_marked(double min_s) const;
};

/// \param reach_s how far to look; no farther than a quarter of what there is
/// \returns nothing with fewer than twenty pieces that can be compared at any of the delays
std::optional<Delay> find_delay(const std::vector<TimedPiece>& pieces, const MotionSource& other,
                                double reach_s);

}  // namespace traverse::plausibility
