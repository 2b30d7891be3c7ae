#pragma once

#include "traverse/geometry/stamp.hpp"

namespace traverse::testing {

/// So many seconds after a start that is not the epoch.
inline geometry::Stamp moment(double seconds) {
  return geometry::Stamp::from_seconds(1000 + seconds);
}

}  // namespace traverse::testing
