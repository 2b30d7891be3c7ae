#pragma once

#include <vector>

#include "traverse/evaluation/poses.hpp"
#include "traverse/evaluation/relation.hpp"
#include "traverse/evaluation/statistics.hpp"

namespace traverse::evaluation {

/// Absolute pose error: how far each pose of the estimate is from its partner.
struct Ape {
  Relation relation = Relation::kTranslation;
  std::vector<double> values;  ///< one a match, in unit_of(relation)
  Statistics statistics;
};

/// Of matched poses, the estimate already aligned. Source: Sturm et al., "A benchmark for the
/// evaluation of RGB-D SLAM systems", IROS 2012; definitions of evo. \throws std::invalid_argument
/// if the sizes differ or are zero, or the relation is not absolute.
Ape ape(const Poses& estimate, const Poses& reference, Relation relation);

}  // namespace traverse::evaluation
