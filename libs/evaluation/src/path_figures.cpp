#include "traverse/evaluation/path_figures.hpp"

#include "traverse/evaluation/relation.hpp"
#include "traverse/geometry/trajectory.hpp"

#include "require_matched.hpp"

namespace traverse::evaluation {

std::vector<double> accumulated_distances(std::span<const geometry::Pose3> poses) {
  return geometry::Trajectory::unstamped({poses.begin(), poses.end()}).accumulated_distances();
}

PathFigures path_figures(std::span<const geometry::Pose3> estimate,
                         std::span<const geometry::Pose3> reference) {
  require_matched(estimate, reference);
  const Motion estimated{estimate.front(), estimate.back()};
  const Motion travelled{reference.front(), reference.back()};
  PathFigures figures;
  figures.estimate_m = accumulated_distances(estimate).back();
  figures.reference_m = accumulated_distances(reference).back();
  figures.end_error_m = relative_error(estimated, travelled, Relation::kTranslation);
  figures.end_rotation_deg = relative_error(estimated, travelled, Relation::kAngleDeg);
  if (figures.reference_m > 0) {
    figures.end_error_percent = 100 * figures.end_error_m / figures.reference_m;
  }
  return figures;
}

}  // namespace traverse::evaluation
