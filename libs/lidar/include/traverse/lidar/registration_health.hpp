#pragma once

#include <cstddef>

#include "traverse/lidar/observability.hpp"
#include "traverse/optimization/termination.hpp"

namespace traverse::lidar {

/// How the registration of a frame went.
struct RegistrationHealth {
  std::size_t line_matches = 0;
  std::size_t plane_matches = 0;
  double residual_rms_m = 0;
  double inlier_share = 0;
  int steps = 0;       ///< of association and solve
  int iterations = 0;  ///< of the solver, all steps together
  Observability observability;
  bool registered = false;  ///< false: the pose is the prediction (or the first frame's identity)
  bool converged = false;   ///< the reason is that it converged
  /// Why it ended. A registration that took a fixed number of steps tells it of the last solve.
  optimization::Termination reason = optimization::Termination::kNotRun;

  std::size_t matches() const { return line_matches + plane_matches; }

  /// Tells why it ended, in one place for `reason` and `converged`.
  void end(optimization::Termination why) {
    reason = why;
    converged = why == optimization::Termination::kConverged;
  }

  /// Covariance of the pose as a twist on its right, T_map_lidar Exp(d): d = (rotation [rad],
  /// translation [m]), both in the axes of the lidar, rotation first. From the information of the
  /// matches and their residuals,
  ///     rms^2 / n (S V diag(lambda) V' S)^-1,  S = diag(rotation scale, 1),
  /// which is right where residuals are independent noise. Real ones are of surfaces that are no
  /// planes, alike from scan to scan: errors are several times larger. A direction that the matches
  /// do not determine has a large variance, not an infinite one, and residuals count as one
  /// centimetre at least. Some microseconds; computed only here.
  Matrix6 covariance() const;
};

}  // namespace traverse::lidar
