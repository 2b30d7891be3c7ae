#pragma once

#include "traverse/config/binder.hpp"
#include "traverse/geometry/pose3.hpp"
#include "traverse/lidar/observability.hpp"
#include "traverse/loam/association.hpp"
#include "traverse/optimization/derivative.hpp"
#include "traverse/optimization/perturbation.hpp"
#include "traverse/optimization/termination.hpp"

namespace traverse::loam {

/// Form of the line residual. Both have the same cost. The vector u x (q - c) determines the two
/// directions across the line and is smooth; A-LOAM uses it. The distance |u x (q - c)|, of F-LOAM
/// and of most text books, has rank 1: it knows only the direction towards the line, nothing of the
/// other one across it, so a solver with it takes more steps; on the line itself its derivative
/// does not exist and is set to zero (line_distance_residual). docs/mathematics.md compares them.
enum class LineForm { kVector, kDistance };

/// Form of the plane residual: n . q + d with its sign, or its absolute value. Both have the same
/// cost and the same Gauss-Newton steps; only derivatives by differences see the kink at zero.
enum class PlaneForm { kSigned, kAbsolute };

/// Least squares for one pose. Forms, derivative and perturbation choose how the same minimum is
/// reached, not which.
struct SolverOptions {
  LineForm line_form = LineForm::kDistance;
  PlaneForm plane_form = PlaneForm::kSigned;
  optimization::Derivative derivative = optimization::Derivative::kAnalytic;
  optimization::Perturbation perturbation = optimization::Perturbation::kRight;
  int iterations = 4;            ///< of Levenberg-Marquardt in one solve
  double huber_m = 0.1;          ///< residuals beyond count linearly
  int min_matches = 20;          ///< with fewer, nothing is solved
  double min_eigenvalue = 0.02;  ///< smaller: the direction is degenerate (Observability)
};
void bind(config::Binder& binder, SolverOptions& options);

/// Outcome of one solve for fixed matches.
struct SolveResult {
  geometry::Pose3 T_map_lidar;
  lidar::Observability observability;  ///< at the solution
  int iterations = 0;
  /// Converged: Ceres' tolerances were met for these matches.
  optimization::Termination reason = optimization::Termination::kNotRun;
  double residual_rms_m = 0;  ///< of all matches at the solution
  double inlier_share = 0;    ///< of the matches, those with |residual| <= huber_m
  bool usable = false;        ///< false: too few matches or the solver failed; pose is the guess
};

/// Moves the pose so that the matched points come onto their lines and planes: Huber-weighted
/// least squares, solved by Ceres. A match with a fraction s below 1 is moved by the part s of the
/// motion (PointMotion). The step from the guess is projected
/// on the directions that the matches determine, so a degenerate direction keeps its prediction.
SolveResult solve_pose(const Matches& matches, const geometry::Pose3& guess_T_map_lidar,
                       const SolverOptions& options);

}  // namespace traverse::loam
