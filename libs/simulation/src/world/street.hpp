#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "traverse/simulation/mesh.hpp"
#include "traverse/simulation/route.hpp"
#include "traverse/simulation/terrain.hpp"

namespace traverse::simulation {

/// The middle of a road, sampled.
struct Street {
  struct Station {
    Eigen::Vector2d point;
    double heading;
    double s;  ///< metres along the street

    Eigen::Vector2d ahead() const { return {std::cos(heading), std::sin(heading)}; }
    Eigen::Vector2d left() const { return {-std::sin(heading), std::cos(heading)}; }
    Eigen::Vector2d beside(double lateral) const { return point + lateral * left(); }
  };
  std::vector<Station> stations;
  bool closed = false;

  double length_m() const { return stations.back().s; }
  Station at(double s) const;
  /// The stretch from `from` to `to`, with a station at least every `every` metres.
  Street part(double from, double to, double every = 1.5) const;
};

/// The road whose right lane is the route: its middle lies `lane_offset` to the left.
Street street_along(const Route& route, double from, double to, double lane_offset, bool closed);
Street straight_street(const Eigen::Vector2d& from, const Eigen::Vector2d& to);

/// One edge of a strip that runs along a street.
struct Edge {
  double lateral;  ///< metres left of the middle
  double height;   ///< above the ground
};

/// The strip between two edges, without the pieces where `is_open` says so of their middle.
void sweep(Mesh& mesh, const Street& street, const Terrain& terrain, Edge from, Edge to,
           Material material, const std::function<bool(const Eigen::Vector2d&)>& is_open = {});

}  // namespace traverse::simulation
