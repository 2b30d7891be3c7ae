#pragma once

#include <string>

#include "traverse/evaluation/evaluate.hpp"

/// How a figure was made, in words, to stand beside it wherever it is shown.
namespace traverse::evaluation {

/// Whose definition a figure follows, and is checked against.
inline constexpr const char* kRuleOfApe = "by evo's rule";
inline constexpr const char* kRuleOfRpe = "by evo's rule";
inline constexpr const char* kRuleOfKittiDrift = "by the rule of KITTI's devkit";
inline constexpr const char* kRuleOfSubTrajectories = "by the rule of rpg_trajectory_evaluation";

/// "514 pairs by stamp, at most 0.01 s apart", "154 pairs by index".
std::string describe(const Association& association);
/// "SE(3) alignment", "Sim(3) alignment on the first 50 poses, scale 0.980412", "no alignment".
/// Names the poses used where they are fewer than `matches`, and what is not determined: "SE(3)
/// alignment, rotation about the line not determined".
std::string describe(const Alignment& alignment, std::size_t matches);
/// "10 frames, all pairs of the estimate".
std::string describe(const RpeOptions& options);

/// "APE translation part, SE(3) alignment, 514 pairs, by evo's rule".
std::string title(const Ape& ape, const Comparison& comparison);
/// "APE translation part, aligned at the first pose, 514 pairs, by evo's rule", of
/// Comparison::ape_at_origin.
std::string title_at_origin(const Ape& ape);
/// "RPE translation part, 10 frames, consecutive pairs of the estimate, SE(3) alignment, 51
/// pairs, by evo's rule".
std::string title(const Rpe& rpe, const Comparison& comparison);
/// "position error along, across and up the path, SE(3) alignment, 514 pairs".
std::string split_title(const Comparison& comparison);
/// What an error that alternates from frame to frame means, with its figures; empty where none
/// does.
std::string alternation_note(const Comparison& comparison);
/// "KITTI drift, camera frame, no alignment, 131 segments of 100 to 800 m, one start every 10
/// poses, 0.1 s per pose, by the rule of KITTI's devkit".
std::string title(const KittiDrift& kitti);
/// "relative errors by length, stretches from every pose of the reference, at most 20 % off the
/// length, no alignment", with the scale where there is one.
std::string sub_trajectories_title(const Comparison& comparison);
/// "path over 514 pairs, no alignment; closing error: distance of the last poses where the first
/// coincide, in % of the reference's path where that is 10 m or more".
std::string path_title(const Comparison& comparison);
/// "map consistency, raw points, 5 to 40 m away, one a 0.2 m voxel, 79125 queries among 3152088
/// points of 108 scans, neighbours within 0.5 m".
std::string title(const Consistency& score);

}  // namespace traverse::evaluation
