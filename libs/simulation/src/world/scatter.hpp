#pragma once

#include <vector>

#include "site.hpp"

namespace traverse::simulation {

/// A few shapes of one kind, made once; each copy is one of them, turned and scaled.
class Assortment {
 public:
  template <typename Make>
  Assortment(std::size_t count, const Make& make) {
    for (std::size_t i = 0; i < count; ++i) shapes_.push_back(make(i));
  }

  const Mesh& pick(Random& random) const { return shapes_[random.below(shapes_.size())]; }

 private:
  std::vector<Mesh> shapes_;
};

/// Puts a copy at `p` if the ground is free over `footprint` (a square's side), and takes it.
/// `height`: of the ground there, above the terrain.
bool plant(Site& site, const Assortment& shapes, const Eigen::Vector2d& p, double footprint,
           double height, double min_scale = 0.8, double max_scale = 1.25);

/// Trees, conifers and bushes as a place needs them.
struct Greenery {
  Assortment trees, conifers, bushes;

  explicit Greenery(Random& random);
};

}  // namespace traverse::simulation
