#include "evidence/gnss_track.hpp"

#include <cmath>

namespace traverse::plausibility {

void GnssTrack::take(double t, const sensors::GnssFix& fix) {
  constexpr double kSpacing_s = 0.08;
  constexpr std::size_t kMaxFixes = 36'000;
  if (!std::isfinite(fix.latitude_deg) || !std::isfinite(fix.longitude_deg)) return;
  if (fix.latitude_deg == 0 && fix.longitude_deg == 0) {
    ++at_zero_;
    return;
  }
  if (fixes_.size() >= kMaxFixes) return;
  if (!fixes_.empty() && t - fixes_.back().t < kSpacing_s) return;
  fixes_.push_back({t, fix.latitude_deg, fix.longitude_deg, fix.altitude_m, fix.heading_deg});
}

}  // namespace traverse::plausibility
