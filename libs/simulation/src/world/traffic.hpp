#pragma once

#include "traverse/simulation/place.hpp"

#include "random.hpp"

namespace traverse::simulation {

/// Vehicles in the opposite lane and pedestrians on the pavements, at constant speed along the
/// route; on a closed one they go round and round.
void add_traffic(Place& place, const PlaceSettings& settings, const Route& route,
                 const Terrain& terrain, Random& random);

}  // namespace traverse::simulation
