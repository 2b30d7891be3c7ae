#include "traverse/slam/localizer.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/so3.hpp"

namespace traverse::slam {

namespace {

bool agree(const geometry::Pose3& a, const geometry::Pose3& b, const LocalizerOptions& options) {
  const geometry::Pose3 between = a.inverse() * b;
  return between.translation.norm() <= options.agreement_m &&
         geometry::angle_of(between.rotation) <= options.agreement_deg * geometry::kDegree;
}

Localizer::Fix told(const MapPlaces::Fit& fit) {
  Localizer::Fix fix;
  fix.verdict = fit.verdict;
  fix.keyframe = fit.keyframe;
  fix.in_common = fit.in_common;
  fix.residual_rms_m = fit.found.health.residual_rms_m;
  return fix;
}

}  // namespace

void bind(config::Binder& b, LocalizerOptions& o) {
  using config::Range;
  b.integer("ring_keys", o.ring_keys, Range::between(1, 100000),
            "nearest ring keys whose Scan Contexts the global search compares");
  b.integer("places", o.places, Range::between(1, 1000),
            "places of the map at which the global search tries a scan");
  b.number("search_radius_m", o.search_radius_m, Range::non_negative(),
           "radius of the search around each place and around a given start");
  b.number("search_half_turn_deg", o.search_half_turn_deg, Range::between(0, 180),
           "half width of the search in heading around a given start");
  b.number("min_in_common", o.checks.min_in_common, Range::between(0, 1),
           "matches of a scan, as a share of what the map's own keyframe has there");
  b.number("max_residual_m", o.checks.max_residual_m, Range::positive(), "rms of the matches");
  b.number("max_rival", o.max_rival, Range::between(0, 1),
           "matches of the next best place, as a share of the best one's");
  b.number("agreement_m", o.agreement_m, Range::positive(), "agreement of two scans in position");
  b.number("agreement_deg", o.agreement_deg, Range::positive(), "agreement in rotation");
  b.number("slip_m", o.slip_m, Range::non_negative(),
           "radius around the odometry pose in which a scan that does not fit is searched for");
  b.integer("witnesses_within", o.witnesses_within, Range::between(1, 10000),
            "earlier scans that may confirm a place");
  b.integer("lost_after", o.lost_after, Range::between(1, 1e6),
            "scans in a row that do not fit, after which the position is lost");
}

Localizer::Localizer(std::vector<MapKeyframe> map, const SlamOptions& options,
                     const LocalizerOptions& search)
    : reach_m_(options.candidates.reach_m),
      sector_rad_(2 * std::numbers::pi / options.candidates.context.sectors),
      search_(search),
      map_(std::move(map), options, search.checks) {}

Localizer::Fix Localizer::locate(const Keyframe& scan) {
  return is_searching() ? find(scan) : follow(scan);
}

Localizer::Fix Localizer::follow(const Keyframe& scan) {
  const geometry::Pose3 guess = *T_map_odom_ * scan.T_odom_lidar;
  const auto nearest = map_.nearest(guess.translation);
  Fix fix;
  fix.keyframe = nearest.number;
  if (nearest.distance <= reach_m_) {
    MapPlaces::Fit fit = map_.fit(guess, {}, scan.features);
    // Odometry may have slipped; the map tells where to.
    if (!fit.fits()) fit = map_.fit(guess, {search_.slip_m, sector_rad_}, scan.features);
    fix = told(fit);
    if (fix.fits()) {
      T_map_odom_ = (fit.T_map_lidar * scan.T_odom_lidar.inverse()).orthonormalised();
    }
  }
  misses_ = fix.fits() ? 0 : misses_ + 1;
  if (misses_ >= search_.lost_after) {
    T_map_odom_.reset();
    return fix;
  }
  fix.located = true;
  fix.T_map_odom = *T_map_odom_;
  return fix;
}

std::vector<MapPlaces::Fit> Localizer::search(const Keyframe& scan) {
  if (start_) {
    const SearchRegion around{search_.search_radius_m,
                              search_.search_half_turn_deg * geometry::kDegree};
    return {map_.fit(*start_, around, scan.features)};
  }
  // Scan Contexts tell the heading to half a sector; neighbours of a place see it a little turned.
  const SearchRegion region{search_.search_radius_m, sector_rad_};
  std::vector<MapPlaces::Fit> fits;
  for (const geometry::Pose3& guess :
       map_.alike(scan.points, static_cast<std::size_t>(search_.ring_keys),
                  static_cast<std::size_t>(search_.places), region)) {
    fits.push_back(map_.fit(guess, region, scan.features));
  }
  return fits;
}

Localizer::Fix Localizer::find(const Keyframe& scan) {
  const bool is_given = start_.has_value();
  const std::vector<MapPlaces::Fit> fits = search(scan);
  start_.reset();  // one that does not fit is not tried twice: the vehicle has moved on
  const auto best = std::max_element(
      fits.begin(), fits.end(), [](const MapPlaces::Fit& a, const MapPlaces::Fit& b) {
        return std::pair(a.fits(), a.found.support) < std::pair(b.fits(), b.found.support);
      });
  if (best == fits.end()) return {};
  Fix fix = told(*best);
  if (!fix.fits()) return fix;

  told_.push_back(contenders(*best, fits, scan));
  if (told_.size() > static_cast<std::size_t>(search_.witnesses_within) + 1) told_.pop_front();
  if (told_.back().size() > 1) {
    fix.verdict = PlaceVerdict::kNotDistinct;
    return fix;
  }
  if (!is_given && !is_confirmed(scan.T_odom_lidar)) {
    fix.verdict = PlaceVerdict::kAlone;
    return fix;
  }
  T_map_odom_ = told_.back().front().orthonormalised();
  told_.clear();
  misses_ = 0;
  fix.located = true;
  fix.T_map_odom = *T_map_odom_;
  return fix;
}

/// The best place and those others that are about as good.
Localizer::Places Localizer::contenders(const MapPlaces::Fit& best,
                                        const std::vector<MapPlaces::Fit>& fits,
                                        const Keyframe& scan) const {
  const geometry::Pose3 T_lidar_odom = scan.T_odom_lidar.inverse();
  Places places{best.T_map_lidar * T_lidar_odom};
  const double rival = search_.max_rival * static_cast<double>(best.found.support);
  for (const MapPlaces::Fit& other : fits) {
    if (static_cast<double>(other.found.support) < rival) continue;
    if (agree(other.T_map_lidar, best.T_map_lidar, search_)) continue;
    places.push_back(other.T_map_lidar * T_lidar_odom);
  }
  return places;
}

/// Whether most of the latest scans, and no less than two, could be at the place of the very
/// latest, and no other place could be that of as many.
bool Localizer::is_confirmed(const geometry::Pose3& T_odom_lidar) const {
  const auto is_there = [&](const geometry::Pose3& a, const geometry::Pose3& b) {
    return agree(a * T_odom_lidar, b * T_odom_lidar, search_);
  };
  const auto scans_for = [&](const geometry::Pose3& place) {
    return static_cast<std::size_t>(
        std::count_if(told_.begin(), told_.end(), [&](const Places& places) {
          return std::any_of(places.begin(), places.end(),
                             [&](const geometry::Pose3& other) { return is_there(place, other); });
        }));
  };
  const geometry::Pose3& place = told_.back().front();
  const std::size_t votes = scans_for(place);
  if (votes < 2 || 2 * votes <= told_.size()) return false;
  return std::all_of(told_.begin(), told_.end(), [&](const Places& places) {
    return std::all_of(places.begin(), places.end(), [&](const geometry::Pose3& other) {
      return is_there(place, other) || scans_for(other) < votes;
    });
  });
}

}  // namespace traverse::slam
