#include "traverse/inertial/factor_kinds.hpp"

#include "residuals/gnss_pose.hpp"
#include "residuals/gnss_position.hpp"
#include "residuals/heading.hpp"
#include "residuals/inertial.hpp"
#include "residuals/prior.hpp"
#include "residuals/sensor_pose.hpp"
#include "residuals/walk.hpp"
#include "residuals/wheel_velocity.hpp"
#include "residuals/world_velocity.hpp"
#include "residuals/zero_velocity.hpp"

namespace traverse::inertial {

using optimization::FactorKind;
using optimization::FactorUse;

std::vector<FactorKind> factor_kinds() {
  std::vector<FactorKind> kinds = InertialResidual::kinds();
  for (FactorKind& walk : walk_kinds()) kinds.push_back(std::move(walk));
  for (const auto& kind :
       {PriorResidual::kind, GnssPositionResidual::kind, HeadingResidual::kind,
        WheelVelocityResidual::kind, ZeroVelocityResidual::kind, GnssPoseResidual::kind,
        WorldVelocityResidual::kind, SensorPoseResidual::kind}) {
    kinds.push_back(kind());
  }
  return kinds;
}

std::vector<FactorUse> factors_of(const NavigationOptions& options, bool has_gnss,
                                  bool has_wheels) {
  std::vector<FactorUse> uses{{InertialResidual::kRotationName},
                              {InertialResidual::kVelocityName},
                              {InertialResidual::kPositionName}};
  for (const FactorKind& walk : walk_kinds()) uses.push_back({walk.name});
  uses.push_back({PriorResidual::kName});
  if (has_gnss) {
    const bool is_pose = options.gnss.form == GnssForm::kPose;
    uses.push_back({is_pose ? GnssPoseResidual::kName : GnssPositionResidual::kName});
    if (!is_pose) uses.push_back({HeadingResidual::kName});
    if (is_pose) uses.push_back({GnssPositionResidual::kName});  // of fixes without a heading
  }
  if (has_wheels && options.wheels.use) {
    const bool is_world = options.wheels.form == WheelForm::kWorldVelocity;
    uses.push_back({is_world ? WorldVelocityResidual::kName : WheelVelocityResidual::kName});
    uses.push_back({ZeroVelocityResidual::kName});
  }
  return uses;
}

std::vector<FactorUse> factors_of_chain(bool has_wheels) {
  std::vector<FactorUse> uses{{InertialResidual::kRotationName},
                              {InertialResidual::kVelocityName},
                              {InertialResidual::kPositionName}};
  for (const FactorKind& walk : walk_kinds()) uses.push_back({walk.name});
  uses.push_back({PriorResidual::kName});
  uses.push_back({SensorPoseResidual::kName});
  if (has_wheels) {
    uses.push_back({WheelVelocityResidual::kName});
    uses.push_back({ZeroVelocityResidual::kName});
  }
  return uses;
}

}  // namespace traverse::inertial
