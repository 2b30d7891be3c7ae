#include "figures/trajectory_figures.hpp"

#include <fmt/format.h>

#include "traverse/render/pictures/trajectory_from_above.hpp"
#include "traverse/render/pictures/trajectory_from_the_side.hpp"

#include "charts/series.hpp"
#include "figures/fixes_beside.hpp"
#include "run/number_texts.hpp"
#include "sections/error_figures.hpp"

namespace traverse::report {

using render::Style;

namespace {

std::string path_statistic(const RunData& run) {
  return run.evaluation.comparison
             ? ape_statistic(*run.evaluation.comparison)
             : fmt::format("{} m in {} poses, no reference",
                           short_number(run.estimate.path_length()), run.estimate.size());
}

}  // namespace

void add_trajectory_figures(const RunData& run, FigureMaker& maker) {
  const geometry::Trajectory estimate = aligned_estimate(run);
  const std::vector<render::NamedTrajectory> named{{"estimate", &estimate}};
  // A reference that could not be matched is in another place: it would only shrink the picture.
  const geometry::Trajectory* reference =
      run.reference && run.evaluation.comparison ? &*run.reference : nullptr;
  const std::string against =
      reference != nullptr ? " against the reference (dashed), after alignment" : "";
  render::BesideTrajectories beside = fixes_beside({&run});
  beside.north_map = north_of_reference(run);
  const bool has_fixes = !beside.fixes.empty();
  const std::string fixes =
      has_fixes ? ", over the fixes; larger where the path jumps most" : std::string();
  maker.add(
      "trajectory", "trajectory-above", "Trajectory from above" + against + fixes + ".",
      [&](const Style& style) {
        return render::trajectory_from_above(
            named, reference, maker.caption("Trajectory from above", path_statistic(run)), style,
            beside);
      },
      has_fixes ? "" : "3d");
  maker.add("trajectory", "trajectory-side", "Height over the distance travelled" + against + ".",
            [&](const Style& style) {
              return render::trajectory_from_the_side(
                  named, reference, maker.caption("Trajectory from the side", path_statistic(run)),
                  style);
            });
}

}  // namespace traverse::report
