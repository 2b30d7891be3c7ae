#include "traverse/evaluation/relation.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "traverse/geometry/so3.hpp"

#include "names.hpp"

namespace traverse::evaluation {

using geometry::Pose3;

namespace {

double rotation_part(const Pose3& E) { return (E.rotation - Eigen::Matrix3d::Identity()).norm(); }

double magnitude(const Pose3& E, Relation relation) {
  switch (relation) {
    case Relation::kTranslation:
      return E.translation.norm();
    case Relation::kRotation:
      return rotation_part(E);
    case Relation::kFull:
      return std::hypot(rotation_part(E), E.translation.norm());
    case Relation::kAngleRad:
      return geometry::angle_of(E.rotation);
    case Relation::kAngleDeg:
      return geometry::angle_of(E.rotation) * 180 / std::numbers::pi;
    case Relation::kPointDistance:
    case Relation::kPointDistanceRatio:
      break;
  }
  throw std::invalid_argument("a point distance is not a function of one transform");
}

double travelled(const Motion& motion) {
  return (motion.T_map_to.translation - motion.T_map_from.translation).norm();
}

}  // namespace

std::string_view name_of(Relation relation) { return name_in(kRelationNames, relation); }

std::string_view title_of(Relation relation) {
  switch (relation) {
    case Relation::kTranslation:
      return "translation part";
    case Relation::kRotation:
      return "rotation part";
    case Relation::kFull:
      return "full transformation";
    case Relation::kAngleRad:
    case Relation::kAngleDeg:
      return "rotation angle";
    case Relation::kPointDistance:
      return "point distance";
    case Relation::kPointDistanceRatio:
      return "point distance ratio";
  }
  return "unknown";
}

std::string_view unit_of(Relation relation) {
  switch (relation) {
    case Relation::kTranslation:
    case Relation::kPointDistance:
      return "m";
    case Relation::kRotation:
    case Relation::kFull:
      return "";
    case Relation::kAngleRad:
      return "rad";
    case Relation::kAngleDeg:
      return "deg";
    case Relation::kPointDistanceRatio:
      return "%";
  }
  return "";
}

double absolute_error(const Pose3& T_estimate, const Pose3& T_reference, Relation relation) {
  if (!is_absolute(relation)) {
    throw std::invalid_argument("the point distance ratio has no absolute form");
  }
  if (relation == Relation::kTranslation || relation == Relation::kPointDistance) {
    return (T_estimate.translation - T_reference.translation).norm();
  }
  return magnitude(T_estimate.inverse() * T_reference, relation);
}

double relative_error(const Motion& estimate, const Motion& reference, Relation relation) {
  if (relation == Relation::kPointDistance || relation == Relation::kPointDistanceRatio) {
    const double distance = travelled(reference);
    const double error = std::abs(distance - travelled(estimate));
    return relation == Relation::kPointDistance ? error : 100 * error / distance;
  }
  const Pose3 reference_motion = reference.T_map_from.inverse() * reference.T_map_to;
  const Pose3 estimated_motion = estimate.T_map_from.inverse() * estimate.T_map_to;
  return magnitude(reference_motion.inverse() * estimated_motion, relation);
}

}  // namespace traverse::evaluation
