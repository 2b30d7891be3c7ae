#include "traverse/slam/localizer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "traverse/geometry/so3.hpp"

namespace traverse::slam {

namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr std::size_t kSubmapsKept = 4;

std::array<float, 3> as_place(const Eigen::Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

}  // namespace

void bind(config::Binder& b, LocalizerOptions& o) {
  using config::Range;
  b.integer("places", o.places, Range::between(1, 1000),
            "of the map that a scan of the global search is tried at");
  b.number("search_radius_m", o.search_radius_m, Range::non_negative(),
           "around each of them, and around a given start");
  b.number("search_half_turn_deg", o.search_half_turn_deg, Range::between(0, 180),
           "to either side");
  b.integer("lost_after", o.lost_after, Range::between(1, 1e6),
            "scans in a row that do not fit: the place is lost");
}

Localizer::Localizer(std::vector<MapKeyframe> map, const SlamOptions& options,
                     const LocalizerOptions& search)
    : options_(options),
      search_(search),
      map_(std::make_shared<const std::vector<MapKeyframe>>(std::move(map))),
      ring_keys_(static_cast<std::size_t>(options.candidates.context.rings)),
      positions_(3) {
  for (const MapKeyframe& keyframe : *map_) {
    const KeyframePoints& points = keyframe.content.points;
    contexts_.emplace_back(points.x, points.y, points.z, options_.candidates.context);
    ring_keys_.add(contexts_.back().ring_key());
    positions_.add(as_place(keyframe.T_map_lidar.translation));
  }
}

std::shared_ptr<const Submap> Localizer::submap_around(std::size_t keyframe) {
  const auto every = static_cast<std::size_t>(options_.submap_every);
  const std::size_t centre = std::min((keyframe + every / 2) / every * every, map_->size() - 1);
  for (const auto& submap : submaps_) {
    if (submap->centre == centre) return submap;
  }
  // The map is optimised: neighbours in space belong together, of whatever lap they are.
  const auto most = static_cast<std::size_t>(options_.submap.keyframes_before +
                                             options_.submap.keyframes_after + 1);
  const MapKeyframe& middle = (*map_)[centre];
  std::vector<std::size_t> around;
  for (const auto& found : positions_.nearest(as_place(middle.T_map_lidar.translation), most)) {
    around.push_back(found.number);
  }
  std::sort(around.begin(), around.end());
  std::vector<PlacedKeyframe> placed;
  for (const std::size_t i : around) {
    placed.push_back({std::shared_ptr<const Keyframe>(map_, &(*map_)[i].content),
                      middle.T_map_lidar.inverse() * (*map_)[i].T_map_lidar});
  }
  submaps_.push_back(
      std::make_shared<const Submap>(make_submap(centre, placed, options_.submap.map)));
  if (submaps_.size() > kSubmapsKept) submaps_.pop_front();
  return submaps_.back();
}

std::optional<Localizer::Place> Localizer::fit(std::size_t keyframe,
                                               const geometry::Pose3& guess_T_map_lidar,
                                               const SearchRegion& region, const Keyframe& scan) {
  const auto submap = submap_around(keyframe);
  const geometry::Pose3& T_map_centre = (*map_)[submap->centre].T_map_lidar;
  const auto starts =
      starts_around(T_map_centre.inverse() * guess_T_map_lidar, region, options_.registration);
  Place place;
  place.keyframe = submap->centre;
  place.found = register_in(*submap, scan.features, starts, options_.registration);
  if (!place.found.health.registered || place.found.health.observability.degenerate > 0 ||
      place.found.overlap < options_.loops.least_overlap ||
      place.found.health.residual_rms_m > options_.loops.most_residual_m) {
    return std::nullopt;
  }
  place.T_map_odom = T_map_centre * place.found.T_centre_lidar * scan.T_odom_lidar.inverse();
  return place;
}

std::vector<Localizer::Place> Localizer::search(const Keyframe& scan) {
  const SearchRegion region{search_.search_radius_m, search_.search_half_turn_deg * kDegree};
  std::vector<Place> places;
  if (start_) {
    const auto nearest = positions_.nearest(as_place(start_->translation), 1);
    if (auto place = fit(nearest.front().number, *start_, region, scan)) {
      places.push_back(std::move(*place));
    }
    return places;
  }
  const ScanContext context(scan.points.x, scan.points.y, scan.points.z,
                            options_.candidates.context);
  std::vector<Candidate> alike;
  for (const auto& found : ring_keys_.nearest(
           context.ring_key(), static_cast<std::size_t>(options_.candidates.ring_keys))) {
    const auto match = ScanContext::compare(contexts_[found.number], context);
    alike.push_back({found.number, match.distance, match.turn_rad});
  }
  std::stable_sort(alike.begin(), alike.end(), [](const Candidate& a, const Candidate& b) {
    return a.descriptor_distance < b.descriptor_distance;
  });
  alike.resize(std::min(alike.size(), static_cast<std::size_t>(search_.places)));
  for (const Candidate& candidate : alike) {
    geometry::Pose3 turn;
    turn.rotation = geometry::exp_so3(Eigen::Vector3d(0, 0, candidate.turn_rad));
    const geometry::Pose3 guess = (*map_)[candidate.keyframe].T_map_lidar * turn;
    if (auto place = fit(candidate.keyframe, guess, region, scan)) {
      places.push_back(std::move(*place));
    }
  }
  return places;
}

bool Localizer::agree(const Place& a, const Place& b, const geometry::Pose3& T_odom_lidar) const {
  const geometry::Pose3 between =
      (a.T_map_odom * T_odom_lidar).inverse() * (b.T_map_odom * T_odom_lidar);
  return between.translation.norm() <= options_.loops.agreement_m &&
         geometry::angle_of(between.rotation) <= options_.loops.agreement_deg * kDegree;
}

Localizer::Fix Localizer::follow(const Keyframe& scan) {
  Fix fix;
  const geometry::Pose3 guess = *T_map_odom_ * scan.T_odom_lidar;
  const auto nearest = positions_.nearest(as_place(guess.translation), 1);
  const auto place = nearest.front().distance <= options_.candidates.reach_m
                         ? fit(nearest.front().number, guess, {}, scan)
                         : std::nullopt;
  fix.keyframe = nearest.front().number;
  if (place) {
    T_map_odom_ = place->T_map_odom.orthonormalised();
    misses_ = 0;
    fix.fits = true;
    fix.keyframe = place->keyframe;
    fix.overlap = place->found.overlap;
    fix.residual_rms_m = place->found.health.residual_rms_m;
  } else if (++misses_ >= search_.lost_after) {
    T_map_odom_.reset();
    return fix;
  }
  fix.located = true;
  fix.T_map_odom = *T_map_odom_;
  return fix;
}

Localizer::Fix Localizer::locate(const Keyframe& scan) {
  if (T_map_odom_) return follow(scan);
  std::vector<Place> places = search(scan);
  for (const Place& place : places) {
    const bool confirmed =
        start_.has_value() ||
        std::any_of(last_search_.begin(), last_search_.end(),
                    [&](const Place& earlier) { return agree(place, earlier, scan.T_odom_lidar); });
    if (!confirmed) continue;
    T_map_odom_ = place.T_map_odom.orthonormalised();
    start_.reset();
    last_search_.clear();
    misses_ = 0;
    return {true,
            true,
            *T_map_odom_,
            place.keyframe,
            place.found.overlap,
            place.found.health.residual_rms_m};
  }
  // A start that does not fit is not tried twice: the vehicle has moved on.
  start_.reset();
  last_search_ = std::move(places);
  return {};
}

}  // namespace traverse::slam
