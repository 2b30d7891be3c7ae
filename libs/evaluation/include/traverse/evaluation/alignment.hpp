#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "traverse/evaluation/poses.hpp"
#include "traverse/geometry/pose3.hpp"

namespace traverse::evaluation {

/// How the estimate is brought into the map frame of the reference.
enum class AlignmentMode {
  kNone,    ///< not at all
  kOrigin,  ///< its first pose onto the first pose of the reference
  kSe3,     ///< rotation and translation of least squares
  kSim3,    ///< rotation, translation and scale of least squares
  kScale,   ///< only the scale of kSim3, about the origin
};

/// The names that the command line and evaluation.json use.
inline constexpr std::array<std::pair<std::string_view, AlignmentMode>, 5> kAlignmentNames{
    {{"none", AlignmentMode::kNone},
     {"origin", AlignmentMode::kOrigin},
     {"se3", AlignmentMode::kSe3},
     {"sim3", AlignmentMode::kSim3},
     {"scale", AlignmentMode::kScale}}};
std::string_view name_of(AlignmentMode mode);

struct AlignmentOptions {
  AlignmentMode mode = AlignmentMode::kNone;
  /// Find the transform from so many poses at the start; from all where it is not set. It is
  /// applied to all either way.
  std::optional<std::size_t> first;
};

/// What positions leave open of the alignment that was asked for.
enum class Undetermined {
  kNothing,
  kRotationAboutLine,  ///< they lie on a line: the rotation about it
  kRotation,           ///< they stand still, or do not agree: all of the rotation
  kRotationAndScale,   ///< the same where the scale was asked for too
  kScale,              ///< the same where only the scale was asked for
};
/// The names that evaluation.json uses, with blanks for readers.
inline constexpr std::array<std::pair<std::string_view, Undetermined>, 5> kUndeterminedNames{
    {{"nothing", Undetermined::kNothing},
     {"rotation about the line", Undetermined::kRotationAboutLine},
     {"rotation", Undetermined::kRotation},
     {"rotation and scale", Undetermined::kRotationAndScale},
     {"scale", Undetermined::kScale}}};
std::string_view name_of(Undetermined undetermined);

/// A pose T of the estimate becomes T_reference_estimate (R, scale * t).
struct Alignment {
  AlignmentMode mode = AlignmentMode::kNone;
  geometry::Pose3 T_reference_estimate;  ///< from the map of the estimate to that of the reference
  double scale = 1;
  std::size_t poses_used = 0;  ///< that determined the transform: 0 for kNone, 1 for kOrigin
  /// What of the transform the positions do not tell. There it holds what rounding and noise make
  /// of the least squares, as in evo; where those fail, what the orientations agree on best, and 1
  /// for the scale.
  Undetermined undetermined = Undetermined::kNothing;
  std::string reason = {};  ///< why, a sentence without a full stop; empty: nothing is left open

  /// Errors of orientation after this alignment mean something.
  bool determines_rotation() const {
    return undetermined == Undetermined::kNothing || undetermined == Undetermined::kScale;
  }

  geometry::Pose3 operator()(const geometry::Pose3& T_estimate_body) const;
};

/// Source: Umeyama, PAMI 1991, on the positions; for kOrigin T_ref0 T_est0^-1.
///
/// Positions on a line do not determine the rotation about it: where those of one trajectory depart
/// from their line by less than a fiftieth of their spread along it, and the two differ across it
/// by no less than either departs. Positions that stand still, or of whose spread less than half is
/// common to both, do not determine any rotation, nor the scale.
/// \throws std::invalid_argument if the sizes differ or are zero, or positions are not finite.
Alignment align(const Poses& estimate, const Poses& reference, const AlignmentOptions& options);

/// `alignment` applied to each pose when it is asked for.
Poses aligned(Poses estimate, const Alignment& alignment);

/// The poses one after the other, to be kept.
std::vector<geometry::Pose3> to_vector(const Poses& poses);

}  // namespace traverse::evaluation
