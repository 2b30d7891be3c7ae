#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/geometry/pose3.hpp"
#include "traverse/simulation/mesh.hpp"
#include "traverse/simulation/route.hpp"
#include "traverse/simulation/terrain.hpp"

namespace traverse::simulation {

enum class PlaceKind { kTown, kHighway, kTunnel, kPark, kCorridor };

/// What is built around a route.
struct PlaceSettings {
  PlaceKind kind = PlaceKind::kTown;
  double half_width_m = 4.5;   ///< of the road, or of the tunnel or corridor
  double lane_offset_m = 1.8;  ///< of the route to the right of the road's middle
  double pavement_m = 2.5;     ///< beside a street
  double height_m = 5.5;       ///< of a tunnel or corridor
  double density = 1;          ///< of trees, parked cars, furniture; 0: none
  bool terraced = false;       ///< a town's houses are all alike, wall to wall
  int vehicles = 0;            ///< that drive
  int pedestrians = 0;         ///< that walk
};
void bind(config::Binder& binder, PlaceSettings& settings);

/// Something that moves by itself.
struct Mover {
  std::size_t shape = 0;                               ///< of Place::shapes
  std::function<geometry::Pose3(double)> T_map_mover;  ///< by seconds of the drive
};

/// Everything that a ray can meet.
struct Place {
  Mesh still;
  std::vector<Mesh> shapes;  ///< of the movers, each about its own origin on the ground
  std::vector<Mover> movers;
};

/// The same place for the same settings and seed.
/// \param route along the road; all drives through one place have the same
/// \param other_drive seed of what moves and what is parked while another drive goes through;
///        nothing: as it was built
Place build_place(const PlaceSettings& settings, const Route& route, const Terrain& terrain,
                  std::uint64_t seed, std::optional<std::uint64_t> other_drive = {});

}  // namespace traverse::simulation
