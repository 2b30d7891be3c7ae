#pragma once

#include "traverse/simulation/analytic_scene.hpp"

namespace traverse::simulation {

/// A street along x from -60 to `length_m` + 60 metres: houses set back by different amounts with
/// gaps between them, kerbs, lamp posts, parked cars. The same houses for the same seed.
AnalyticScene street(double length_m, unsigned seed);

/// A straight tunnel along x without any feature: motion along it cannot be seen.
AnalyticScene tunnel(double length_m);

}  // namespace traverse::simulation
