#pragma once

#include <optional>

#include "traverse/sensors/gnss_fix.hpp"

#include "navigation/map_fix.hpp"

namespace traverse::inertial {

/// Which fix makes the origin of the map: the first that the next one agrees with, as far as a
/// vehicle can have gone in between. A receiver's first fixes may be of its last place or of none.
class FirstFixes {
 public:
  /// \returns the origin's fix, `fix` or one before it, when there is one
  std::optional<sensors::GnssFix> add(const sensors::GnssFix& fix, Events& events);

 private:
  std::optional<sensors::GnssFix> candidate_;
};

}  // namespace traverse::inertial
