#pragma once

#include "traverse/simulation/mesh.hpp"

#include "random.hpp"

/// Things that stand on the ground at the origin, facing x where they have a front.
namespace traverse::simulation {

Mesh make_car(Random& random);  ///< sizes and shapes from hatchback to van
Mesh make_lorry();
Mesh make_lamp_post(double height);  ///< its arm reaches towards y
Mesh make_sign(Random& random);
Mesh make_traffic_light();
Mesh make_bench();
Mesh make_bin();
Mesh make_bus_shelter();
Mesh make_pedestrian(Random& random);
Mesh make_gantry(double span);  ///< across a motorway along y, its sign above the middle
Mesh make_pavilion(Random& random);

}  // namespace traverse::simulation
