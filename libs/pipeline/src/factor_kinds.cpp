#include "traverse/pipeline/factor_kinds.hpp"

#include <iterator>
#include <stdexcept>
#include <utility>

#include "traverse/inertial/factor_kinds.hpp"
#include "traverse/loam/factor_kinds.hpp"
#include "traverse/pose_graph/factor_kinds.hpp"
#include "traverse/voxel_map/row_factor_kinds.hpp"

namespace traverse::pipeline {

namespace {

std::vector<optimization::FactorKind>& registered_factor_kinds() {
  static std::vector<optimization::FactorKind> kinds;
  return kinds;
}

}  // namespace

std::vector<optimization::FactorKind> factor_kinds() {
  std::vector<optimization::FactorKind> all;
  const auto add = [&](std::vector<optimization::FactorKind> kinds) {
    std::move(kinds.begin(), kinds.end(), std::back_inserter(all));
  };
  add(loam::factor_kinds());
  add(voxel_map::row_factor_kinds());
  add(inertial::factor_kinds());
  add(pose_graph::factor_kinds());
  add(registered_factor_kinds());
  return all;
}

void register_factor_kinds(std::vector<optimization::FactorKind> kinds) {
  for (optimization::FactorKind& kind : kinds) {
    for (const optimization::FactorKind& present : factor_kinds()) {
      if (present.name != kind.name) continue;
      throw std::invalid_argument("there is a factor of the name '" + kind.name + "'");
    }
    registered_factor_kinds().push_back(std::move(kind));
  }
}

}  // namespace traverse::pipeline
