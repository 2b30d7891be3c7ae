#include "traverse/slam/map_places.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "traverse/geometry/so3.hpp"

namespace traverse::slam {

namespace {

constexpr std::size_t kPlaceSubmapsKept = 16;
/// Points that starts are told apart by: the place that most of them fall into is the same as with
/// all of a scan's.
constexpr std::size_t kFewPoints = 500;
constexpr double kSpacingOfRegion = 0.5;  ///< of the starts at most, shares of the radius

voxel_map::SweepPoints every(std::size_t step, const voxel_map::SweepPoints& all) {
  voxel_map::SweepPoints points;
  for (std::size_t i = 0; i < all.size(); i += step) points.append(all, i);
  return points;
}

/// About kFewPoints of those that a scan is registered by, from all over it.
voxel_map::SweepSample few_of(const voxel_map::SweepSample& features) {
  const std::size_t count = features.planar.size() + features.edges.size();
  const std::size_t step = std::max<std::size_t>(1, count / kFewPoints);
  voxel_map::SweepSample few;
  few.planar = every(step, features.planar);
  few.edges = every(step, features.edges);
  return few;
}

bool covers(const SearchRegion& region, const geometry::Pose3& guess, const geometry::Pose3& pose) {
  const geometry::Pose3 between = guess.inverse() * pose;
  return between.translation.norm() <= region.radius_m &&
         geometry::angle_of(between.rotation) <= region.half_turn_rad;
}

double support_a_point(const LoopRegistration& found, const voxel_map::SweepSample& features) {
  const std::size_t most = features.planar.size() + 2 * features.edges.size();
  return most == 0 ? 0 : static_cast<double>(found.support) / static_cast<double>(most);
}

PlaceVerdict judge(const MapPlaces::Fit& fit, const PlaceChecks& checks) {
  const lidar::RegistrationHealth& health = fit.found.health;
  if (!health.registered) return PlaceVerdict::kNotRegistered;
  if (health.observability.degenerate > 0) return PlaceVerdict::kDegenerate;
  if (fit.in_common < checks.min_in_common) return PlaceVerdict::kLittleInCommon;
  if (health.residual_rms_m > checks.max_residual_m) return PlaceVerdict::kResidual;
  return PlaceVerdict::kFits;
}

}  // namespace

std::string_view name_of(PlaceVerdict verdict) {
  switch (verdict) {
    case PlaceVerdict::kFits:
      return "fits";
    case PlaceVerdict::kNotRegistered:
      return "not registered";
    case PlaceVerdict::kDegenerate:
      return "degenerate";
    case PlaceVerdict::kLittleInCommon:
      return "little in common";
    case PlaceVerdict::kResidual:
      return "residual";
    case PlaceVerdict::kNotDistinct:
      return "not distinct";
    case PlaceVerdict::kAlone:
      return "alone";
  }
  return {};
}

MapPlaces::MapPlaces(std::vector<MapKeyframe> map, const SlamOptions& options,
                     const PlaceChecks& checks)
    : options_(options), checks_(checks) {
  if (map.empty()) throw std::invalid_argument("a map without keyframes");
  const ScanContextOptions& look = options.candidates.context;
  auto content = std::make_shared<Content>(
      Content{std::move(map), {}, PlaceIndex(static_cast<std::size_t>(look.rings))});
  for (const MapKeyframe& keyframe : content->keyframes) {
    const KeyframePoints& points = keyframe.content.points;
    content->contexts.emplace_back(points.x, points.y, points.z, look);
    content->ring_keys.add(content->contexts.back().ring_key());
    content->positions.add(as_place(keyframe.T_map_lidar.translation));
  }
  map_ = std::move(content);
}

PlaceIndex::Found MapPlaces::nearest(const Eigen::Vector3d& p_map) const {
  return map_->positions.nearest(as_place(p_map), 1).front();
}

std::vector<geometry::Pose3> MapPlaces::alike(const KeyframePoints& scan, std::size_t ring_keys,
                                              std::size_t most, const SearchRegion& region) const {
  const ScanContext context(scan.x, scan.y, scan.z, options_.candidates.context);
  std::vector<Candidate> alike;
  for (const auto& found : map_->ring_keys.nearest(context.ring_key(), ring_keys)) {
    const auto match = ScanContext::compare(map_->contexts[found.number], context);
    alike.push_back({found.number, match.distance, match.turn_rad});
  }
  std::stable_sort(alike.begin(), alike.end(), [](const Candidate& a, const Candidate& b) {
    return a.descriptor_distance < b.descriptor_distance;
  });
  std::vector<geometry::Pose3> guesses;
  for (const Candidate& candidate : alike) {
    if (guesses.size() == most) break;
    geometry::Pose3 turn;
    turn.rotation = geometry::exp_so3(Eigen::Vector3d(0, 0, candidate.turn_rad));
    const geometry::Pose3 guess = map_->keyframes[candidate.keyframe].T_map_lidar * turn;
    const bool is_covered =
        std::any_of(guesses.begin(), guesses.end(),
                    [&](const geometry::Pose3& earlier) { return covers(region, earlier, guess); });
    if (!is_covered) guesses.push_back(guess);
  }
  return guesses;
}

MapPlaces::Fit MapPlaces::fit(const geometry::Pose3& guess_T_map_lidar, const SearchRegion& region,
                              const voxel_map::SweepSample& features) {
  const auto around = surroundings(nearest(guess_T_map_lidar.translation).number);
  const Submap& submap = around->submap;
  const geometry::Pose3& T_map_centre = map_->keyframes[submap.centre].T_map_lidar;
  LoopRegistrationOptions how = options_.registration;
  if (region.radius_m > 0) {
    how.start_spacing_m = std::min(how.start_spacing_m, region.radius_m * kSpacingOfRegion);
  }
  auto starts = starts_around(T_map_centre.inverse() * guess_T_map_lidar, region, how);
  if (starts.size() > 1) {
    starts = {register_in(submap, few_of(features), starts, how).T_centre_lidar};
  }
  Fit fit;
  fit.keyframe = submap.centre;
  fit.found = register_in(submap, features, starts, how);
  fit.T_map_lidar = T_map_centre * fit.found.T_centre_lidar;
  if (around->own_support > 0) {
    fit.in_common = support_a_point(fit.found, features) / around->own_support;
  }
  fit.verdict = judge(fit, checks_);
  return fit;
}

std::shared_ptr<const MapPlaces::Surroundings> MapPlaces::surroundings(std::size_t keyframe) {
  const auto every = static_cast<std::size_t>(options_.submap_every);
  const std::vector<MapKeyframe>& keyframes = map_->keyframes;
  const std::size_t centre = std::min((keyframe + every / 2) / every * every, keyframes.size() - 1);
  const auto known =
      std::find_if(surroundings_.begin(), surroundings_.end(),
                   [&](const auto& around) { return around->submap.centre == centre; });
  if (known != surroundings_.end()) {
    std::rotate(known, known + 1, surroundings_.end());
    return surroundings_.back();
  }
  // The map is optimised: neighbours in space belong together, of whatever lap they are.
  const auto most = static_cast<std::size_t>(options_.submap.keyframes_before +
                                             options_.submap.keyframes_after + 1);
  const geometry::Pose3& T_map_centre = keyframes[centre].T_map_lidar;
  std::vector<std::size_t> around;
  for (const auto& found : map_->positions.nearest(as_place(T_map_centre.translation), most)) {
    around.push_back(found.number);
  }
  std::sort(around.begin(), around.end());
  std::vector<PlacedKeyframe> placed;
  for (const std::size_t i : around) {
    placed.push_back({std::shared_ptr<const Keyframe>(map_, &keyframes[i].content),
                      T_map_centre.inverse() * keyframes[i].T_map_lidar});
  }
  Surroundings made{make_submap(centre, placed, options_.submap.map), 0};
  const voxel_map::SweepSample& own = keyframes[centre].content.features;
  const std::vector<geometry::Pose3> there{geometry::Pose3::identity()};
  made.own_support =
      support_a_point(register_in(made.submap, own, there, options_.registration), own);
  surroundings_.push_back(std::make_shared<const Surroundings>(std::move(made)));
  if (surroundings_.size() > kPlaceSubmapsKept) surroundings_.pop_front();
  return surroundings_.back();
}

}  // namespace traverse::slam
