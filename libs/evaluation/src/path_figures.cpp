#include "traverse/evaluation/path_figures.hpp"

#include "traverse/evaluation/relation.hpp"

#include "require_matched.hpp"

namespace traverse::evaluation {

namespace {

/// Calls `take` with the path length from the first pose to each.
template <typename Take>
void walk(const Poses& poses, Take take) {
  double path_m = 0;
  Eigen::Vector3d last;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector3d here = poses[i].translation;
    if (i > 0) path_m += (here - last).norm();
    last = here;
    take(path_m);
  }
}

}  // namespace

std::vector<double> accumulated_distances(const Poses& poses) {
  std::vector<double> distances;
  distances.reserve(poses.size());
  walk(poses, [&](double path_m) { distances.push_back(path_m); });
  return distances;
}

double path_length(const Poses& poses) {
  double length_m = 0;
  walk(poses, [&](double path_m) { length_m = path_m; });
  return length_m;
}

PathFigures path_figures(const Poses& estimate, const Poses& reference) {
  require_matched(estimate, reference);
  const Motion estimated{estimate.front(), estimate.back()};
  const Motion travelled{reference.front(), reference.back()};
  PathFigures figures;
  figures.estimate_m = path_length(estimate);
  figures.reference_m = path_length(reference);
  figures.end_error_m = relative_error(estimated, travelled, Relation::kTranslation);
  figures.end_rotation_deg = relative_error(estimated, travelled, Relation::kAngleDeg);
  if (figures.reference_m >= kLeastPathForPercent_m) {
    figures.end_error_percent = 100 * figures.end_error_m / figures.reference_m;
  }
  return figures;
}

}  // namespace traverse::evaluation
