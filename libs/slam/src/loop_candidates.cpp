#include "traverse/slam/loop_candidates.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace traverse::slam {

namespace {

constexpr double kMostMoved_m = 1;    // from where the index has them, before it is made anew
constexpr double kRounding_m = 0.01;  // of positions as floats, far from the origin

}  // namespace

void bind(config::Binder& b, CandidateOptions& o) {
  using config::Range;
  b.number("min_way_m", o.min_way_m, Range::positive(),
           "path length since the candidate; nearer keyframes are the present surroundings");
  b.number("reach_m", o.reach_m, Range::positive(), "keyframes farther apart make no loop");
  b.number("sigmas", o.sigmas, Range::non_negative(),
           "standard deviations of the predicted position by which reach_m grows");
  b.integer("ring_keys", o.ring_keys, Range::between(1, 1000),
            "nearest ring keys whose Scan Contexts are compared");
  b.number("max_descriptor_distance", o.max_descriptor_distance, Range::between(0, 1),
           "largest distance between the Scan Contexts of one place");
  b.group("context", "the Scan Context of a keyframe",
          [&](config::Binder& g) { bind(g, o.context); });
}

LoopCandidates::LoopCandidates(const CandidateOptions& options)
    : options_(options),
      ring_keys_(static_cast<std::size_t>(options.context.rings)),
      positions_(3) {}

void LoopCandidates::add(ScanContext context, double way_m, const Eigen::Vector3d& p_map) {
  contexts_.push_back(std::move(context));
  way_m_.push_back(way_m);
  p_map_.push_back(p_map);
  let_find(way_m);
}

void LoopCandidates::let_find(double way_m) {
  while (findable() < contexts_.size() && way_m_[findable()] + options_.min_way_m <= way_m) {
    ring_keys_.add(contexts_[findable()].ring_key());
    p_indexed_.push_back(p_map_[findable()]);
    positions_.add(as_place(p_indexed_.back()));
  }
}

std::optional<Candidate> LoopCandidates::by_position(const Eigen::Vector3d& p_map,
                                                     double reach_m) const {
  const auto nearest = positions_.nearest(as_place(p_map), 1);
  const double off_m = moved_m_ + kRounding_m;
  if (nearest.empty() || nearest.front().distance > reach_m + off_m) return std::nullopt;
  // Whoever is nearest now was at most that far away when the index was made.
  const double search_m = nearest.front().distance + 2 * off_m;
  std::optional<std::size_t> best;
  double best_m = reach_m;
  for (const auto& found : positions_.within(as_place(p_map), search_m)) {
    const double distance_m = (p_map_[found.number] - p_map).norm();
    if (distance_m > best_m || (best && distance_m == best_m)) continue;
    best = found.number;
    best_m = distance_m;
  }
  if (!best) return std::nullopt;
  return Candidate{*best, 1, 0};
}

std::vector<Candidate> LoopCandidates::by_appearance(const ScanContext& context) const {
  std::vector<Candidate> candidates;
  for (const std::size_t keyframe :
       ring_keys_.nearest(context.ring_key(), static_cast<std::size_t>(options_.ring_keys))) {
    const auto match = ScanContext::compare(contexts_[keyframe], context);
    if (match.distance > options_.max_descriptor_distance) continue;
    candidates.push_back({keyframe, match.distance, match.turn_rad});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) {
                     return a.descriptor_distance < b.descriptor_distance;
                   });
  return candidates;
}

void LoopCandidates::move(const std::vector<Eigen::Vector3d>& p_map) {
  p_map_ = p_map;
  moved_m_ = 0;
  for (std::size_t i = 0; i < findable(); ++i) {
    moved_m_ = std::max(moved_m_, (p_map_[i] - p_indexed_[i]).norm());
  }
  if (moved_m_ > kMostMoved_m) index_positions();
}

void LoopCandidates::index_positions() {
  const std::size_t count = findable();
  std::vector<float> places;
  for (std::size_t i = 0; i < count; ++i) {
    const auto place = as_place(p_map_[i]);
    places.insert(places.end(), place.begin(), place.end());
  }
  positions_ = PlaceIndex(3);
  positions_.add(places);
  p_indexed_.assign(p_map_.begin(), p_map_.begin() + static_cast<std::ptrdiff_t>(count));
  moved_m_ = 0;
}

}  // namespace traverse::slam
