#include "traverse/pipeline/factor_kinds.hpp"

#include <iterator>
#include <utility>

#include "traverse/inertial/factor_kinds.hpp"
#include "traverse/loam/factor_kinds.hpp"
#include "traverse/pose_graph/factor_kinds.hpp"
#include "traverse/voxel_map/row_factor_kinds.hpp"

namespace traverse::pipeline {

std::vector<optimization::FactorKind> factor_kinds() {
  std::vector<optimization::FactorKind> all;
  const auto add = [&](std::vector<optimization::FactorKind> kinds) {
    std::move(kinds.begin(), kinds.end(), std::back_inserter(all));
  };
  add(loam::factor_kinds());
  add(voxel_map::row_factor_kinds());
  add(inertial::factor_kinds());
  add(pose_graph::factor_kinds());
  return all;
}

}  // namespace traverse::pipeline
