#pragma once

#include "traverse/config/binder.hpp"
#include "traverse/geometry/pose3.hpp"
#include "traverse/lidar/association.hpp"
#include "traverse/lidar/degeneracy.hpp"

namespace traverse::lidar {

/// Form of the line residual. The vector determines two directions across the line; the distance
/// only one, so a solver with it takes about twice the steps (rank 1 against 2).
enum class LineForm { kVector, kDistance };

struct SolverOptions {
  LineForm line_form = LineForm::kDistance;
  int iterations = 4;              ///< of Levenberg-Marquardt in one solve
  double huber_m = 0.1;            ///< residuals beyond count linearly
  int least_matches = 20;          ///< with fewer, nothing is solved
  double least_eigenvalue = 0.02;  ///< smaller: the direction is degenerate (Observability)
};
void bind(config::Binder& binder, SolverOptions& options);

/// Outcome of one solve for fixed matches.
struct SolveResult {
  geometry::Pose3 T_map_lidar;
  Observability observability;  ///< at the solution
  int iterations = 0;
  double residual_rms_m = 0;  ///< of all matches at the solution
  double inlier_share = 0;    ///< of the matches, those with |residual| <= huber_m
  bool usable = false;        ///< false: too few matches or the solver failed; pose is the guess
};

/// Moves the pose so that the matched points come onto their lines and planes: Huber-weighted
/// least squares with analytic derivatives, solved by Ceres. The step from the guess is projected
/// on the directions that the matches determine, so a degenerate direction keeps its prediction.
SolveResult solve_pose(const Matches& matches, const geometry::Pose3& guess_T_map_lidar,
                       const SolverOptions& options);

}  // namespace traverse::lidar
