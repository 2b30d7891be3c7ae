#include "scatter.hpp"

#include <numbers>

#include "plants.hpp"

namespace traverse::simulation {

bool plant(Site& site, const Assortment& shapes, const Eigen::Vector2d& p, double footprint,
           double height, double min_scale, double max_scale) {
  if (!site.plan.is_free(p, 0, {footprint, footprint})) return false;
  site.plan.take(p, 0, {footprint, footprint});
  const double scale = site.random.uniform(min_scale, max_scale);
  const double yaw = site.random.uniform(0, 2 * std::numbers::pi);
  site.mesh.add(shapes.pick(site.random), upright(site.on_ground(p, height), yaw), scale);
  return true;
}

Greenery::Greenery(Random& random)
    : trees(7,
            [&](std::size_t i) { return make_tree(6.5 + 0.8 * static_cast<double>(i), random); }),
      conifers(
          4, [&](std::size_t i) { return make_conifer(7 + 1.5 * static_cast<double>(i), random); }),
      bushes(5, [&](std::size_t i) {
        return make_bush(0.6 + 0.15 * static_cast<double>(i), random);
      }) {}

}  // namespace traverse::simulation
