#pragma once

#include <optional>

#include "traverse/geometry/stamp.hpp"

namespace traverse::exports {

/// GPS time less 1e9 s, which LAS calls adjusted standard GPS time, of a stamp of Unix time:
/// seconds since 1980-01-06 with the leap seconds that had been put in by then (18 since 2017; IERS
/// Bulletin C). Nothing of a stamp before 1980-01-06, which is of a clock that knows no date. Twice
/// the leap second itself Unix time repeats, so that stamps within it are a second off.
std::optional<double> adjusted_gps_time(geometry::Stamp unix_time);

}  // namespace traverse::exports
