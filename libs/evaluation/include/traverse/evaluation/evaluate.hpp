#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "traverse/evaluation/alignment.hpp"
#include "traverse/evaluation/ape.hpp"
#include "traverse/evaluation/association.hpp"
#include "traverse/evaluation/consistency.hpp"
#include "traverse/evaluation/error_split.hpp"
#include "traverse/evaluation/evaluation_error.hpp"
#include "traverse/evaluation/kitti_drift.hpp"
#include "traverse/evaluation/path_figures.hpp"
#include "traverse/evaluation/rpe.hpp"
#include "traverse/evaluation/sub_trajectories.hpp"
#include "traverse/evaluation/trajectory_view.hpp"

namespace traverse::evaluation {

/// What is computed beyond the association, and how.
struct EvaluationOptions {
  AssociationOptions association;
  AlignmentOptions alignment;
  std::vector<Relation> ape_relations{Relation::kTranslation, Relation::kAngleDeg};
  std::vector<Relation> rpe_relations{Relation::kTranslation, Relation::kAngleDeg};
  std::vector<RpeOptions> rpe;
  KittiDriftOptions kitti;
  std::vector<double> sub_trajectory_lengths_m;  ///< empty: sub_trajectory_lengths()
  /// An RPE without a pair is an EvaluationError; if false it is listed in Comparison::undefined.
  bool rpe_must_exist = true;
};

/// What a run is evaluated with: SE(3) alignment, every relation, RPE over 1, 10, 50 and 100 frames
/// and over 100 m with all pairs; what a short run does not allow is listed as undefined.
EvaluationOptions run_evaluation_options();

/// A trajectory that took part, whole: also the poses that found no partner.
struct TrajectoryFacts {
  std::string name;  ///< usually the file
  std::size_t poses = 0;
  double path_m = 0;
  std::optional<geometry::Stamp> first;  ///< nothing without stamps
  std::optional<geometry::Stamp> last;
  std::string read_as = {};             ///< "TUM, 8 columns between blanks"; empty: from no file
  std::vector<std::string> notes = {};  ///< what its file gave rise to
};

/// A figure that the trajectories do not define.
struct Undefined {
  std::string metric;  ///< "KITTI drift", "RPE, 100 m, all pairs of the estimate"
  std::string reason;  ///< "the path of the reference is 70.1 m long"
};

/// An estimate against a reference. Element k of matches, stamps, distances and of each ape values
/// belong together; indices in rpe and kitti count the same elements.
struct Comparison {
  TrajectoryFacts reference;
  Association association;
  std::vector<geometry::Stamp> stamps;  ///< of the estimate's poses; empty when matched by index
  std::vector<double> distances_m;      ///< along the reference from the first match
  Alignment alignment;
  std::vector<Ape> ape;  ///< of the relations that the alignment determines
  /// Aligned at the first pose instead, of all relations, where the alignment is not determined.
  std::vector<Ape> ape_at_origin;
  std::optional<ErrorSplit> split;  ///< of the position errors; nothing where the reference stands
  std::vector<Rpe> rpe;             ///< option after option, each with all relations
  std::optional<KittiDrift> kitti;  ///< of the poses as they are, not aligned
  std::vector<SubTrajectoryErrors> sub_trajectories;  ///< of the poses as they are, but scaled
  PathFigures path;                                   ///< of the poses as they are, not aligned
  std::vector<Undefined> undefined;
  /// Why the figures may stand for little: few poses that found a match.
  std::vector<std::string> warnings;
};

/// The errors of that relation, or null if they were not computed.
const Ape* find_ape(const Comparison& comparison, Relation relation);
/// Those over so many frames, or null.
const Rpe* find_rpe(const Comparison& comparison, Relation relation, double frames);

/// Everything that is known about the accuracy of a trajectory.
struct Evaluation {
  TrajectoryFacts estimate;
  std::optional<Comparison> comparison;    ///< nothing without a reference
  std::optional<Consistency> consistency;  ///< nothing without scans
};

/// \throws EvaluationError as the parts do, and for a pose that is not finite.
Evaluation evaluate(const TrajectoryView& estimate, const TrajectoryView& reference,
                    const EvaluationOptions& options);

/// Of an estimate without a reference: only its facts, to which a Consistency may be added.
Evaluation evaluate(const TrajectoryView& estimate);

}  // namespace traverse::evaluation
