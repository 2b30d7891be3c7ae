#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "traverse/evaluation/poses.hpp"
#include "traverse/evaluation/statistics.hpp"

namespace traverse::evaluation {

/// Errors over all stretches of one length: one value a start.
struct SubTrajectoryErrors {
  double length_m = 0;
  Statistics translation_m;
  Statistics translation_percent;  ///< of the length
  Statistics rotation_deg;
  Statistics rotation_deg_per_m;
  Statistics yaw_deg;      ///< about the z axis of the estimate's frame
  Statistics gravity_deg;  ///< of pitch and roll together
};

/// The lengths of rpg_trajectory_evaluation where none are given: 10, 20, 30, 40 and 50 % of the
/// path of the whole reference, cut to centimetres.
std::vector<double> sub_trajectory_lengths(double path_m);

/// Relative errors by the length of the stretch, as rpg_trajectory_evaluation defines them (Zhang
/// and Scaramuzza, "A Tutorial on Quantitative Trajectory Evaluation for Visual(-Inertial)
/// Odometry", IROS 2018). From each pose a stretch leads to that later pose whose distance along
/// the reference from it is nearest to the length, if it is off by less than a fifth of it. Starts
/// from which there is none are left out; that program pairs the following starts wrongly after one
/// within a path, which happens where the reference jumps.
/// \param scale of the estimate, from its alignment; the poses are those before it
/// \return what has at least two stretches; nothing for the other lengths.
/// \throws std::invalid_argument if the sizes differ or a length is not positive.
std::vector<SubTrajectoryErrors> sub_trajectory_errors(const Poses& estimate,
                                                       const Poses& reference, double scale,
                                                       const std::vector<double>& lengths_m);

}  // namespace traverse::evaluation
