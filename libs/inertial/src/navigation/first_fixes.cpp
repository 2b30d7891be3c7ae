#include "navigation/first_fixes.hpp"

#include <algorithm>

#include "traverse/geodesy/local_tangent_plane.hpp"

namespace traverse::inertial {

std::optional<sensors::GnssFix> FirstFixes::add(const sensors::GnssFix& fix, Events& events) {
  constexpr double kFastest = 100;  // m/s, of anything on wheels
  constexpr double kWorst = 100;  // m that two fixes of one place differ by, code alone, in a town
  if (candidate_) {
    const geodesy::LocalTangentPlane plane(
        {candidate_->latitude_deg, candidate_->longitude_deg, candidate_->altitude_m});
    const double way = plane.to_enu({fix.latitude_deg, fix.longitude_deg, fix.altitude_m}).norm();
    const double seconds = std::max(0.0, geometry::seconds_between(candidate_->stamp, fix.stamp));
    if (way <= kWorst + kFastest * seconds) return candidate_;
    ++events["first fix that the next does not agree with"];
  }
  candidate_ = fix;
  return std::nullopt;
}

}  // namespace traverse::inertial
