#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "traverse/geometry/pose3.hpp"

namespace traverse::evaluation {

/// What is measured of the transform E that separates two poses, or two motions.
enum class Relation {
  kTranslation,         ///< |t_E|, metres
  kRotation,            ///< |R_E - I|_F = 2 sqrt(2) sin(angle / 2), no unit
  kFull,                ///< |E - I|_F, no unit: metres and rotation mixed
  kAngleRad,            ///< |Log R_E|, radians
  kAngleDeg,            ///< |Log R_E|, degrees
  kPointDistance,       ///< APE: |t_E|. RPE: difference of the lengths of the two motions. Metres
  kPointDistanceRatio,  ///< RPE only: the same in percent of the reference's motion
};

/// The names that the command line and evaluation.json use.
inline constexpr std::array<std::pair<std::string_view, Relation>, 7> kRelationNames{
    {{"translation", Relation::kTranslation},
     {"rotation", Relation::kRotation},
     {"full", Relation::kFull},
     {"angle-rad", Relation::kAngleRad},
     {"angle-deg", Relation::kAngleDeg},
     {"point-distance", Relation::kPointDistance},
     {"point-distance-ratio", Relation::kPointDistanceRatio}}};
std::string_view name_of(Relation relation);
std::string_view title_of(Relation relation);  ///< "translation part", "rotation angle"
std::string_view unit_of(Relation relation);   ///< "m", "rad", "deg", "%", or empty

/// A ratio of distances travelled is defined between two moments only.
constexpr bool is_absolute(Relation relation) { return relation != Relation::kPointDistanceRatio; }

/// The error of one pose, E = T_estimate^-1 T_reference, both T_map_body.
/// \throws std::invalid_argument if the relation is not absolute.
double absolute_error(const geometry::Pose3& T_estimate, const geometry::Pose3& T_reference,
                      Relation relation);

/// The motion from one moment to another, as the poses at both.
struct Motion {
  geometry::Pose3 T_map_from;
  geometry::Pose3 T_map_to;
};

/// The error of one motion, E = (reference motion)^-1 (estimated motion). For kPointDistanceRatio
/// the reference must have moved.
double relative_error(const Motion& estimate, const Motion& reference, Relation relation);

}  // namespace traverse::evaluation
