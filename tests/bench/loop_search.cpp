#include "loop_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "traverse/slam/loop_candidates.hpp"

#include "cpu_seconds.hpp"

namespace traverse::testing {

namespace {

constexpr double kReach_m = 20;  // of a search by position

double squared_distance(std::span<const float> a, std::span<const float> b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double difference = static_cast<double>(a[k]) - static_cast<double>(b[k]);
    sum += difference * difference;
  }
  return sum;
}

/// Microseconds a keyframe, when there are `keyframes` before it.
struct Row {
  std::size_t keyframes = 0;
  double add = 0;         ///< mean since the row before
  double ring_keys = 0;   ///< the nearest ones
  double looked_at = 0;   ///< keys, for these; no microseconds
  double appearance = 0;  ///< these and the comparison of their Scan Contexts
  double position = 0;    ///< the nearest one
  double move = 0;        ///< all of them, after a solution of the graph
  double recall = 0;      ///< share of the nearest ring keys that are found

  double search() const { return add + appearance + position; }
};

/// Grows with the drive.
class Search {
 public:
  explicit Search(std::span<const SimulatedPlace> places)
      : places_(places), candidates_({}), ring_keys_(ring_key(0).size()) {}

  Row at(std::size_t keyframes) {
    Row row;
    row.keyframes = keyframes;
    const std::size_t added = keyframes - size_;
    const double seconds = cpu_seconds_of([&] {
      for (; size_ < keyframes; ++size_) {
        const SimulatedPlace& place = places_[size_];
        candidates_.add(place.context, place.way_m, place.p_map);
      }
    });
    row.add = 1e6 * seconds / static_cast<double>(added);
    while (ring_keys_.size() < candidates_.findable()) {
      ring_keys_.add(ring_key(ring_keys_.size()));
    }
    const auto asked = places_.subspan(keyframes, kSearches);
    const auto mean_us = [&](const auto& search) {
      return 1e6 / static_cast<double>(asked.size()) * cpu_seconds_of([&] {
               for (const SimulatedPlace& place : asked) search(place);
             });
    };
    std::size_t found = 0;  // so that nothing is optimised away
    const std::size_t looked_at = ring_keys_.looked_at();
    row.ring_keys = mean_us([&](const SimulatedPlace& place) {
      found += ring_keys_.nearest(place.context.ring_key(), kRingKeys).size();
    });
    row.looked_at =
        static_cast<double>(ring_keys_.looked_at() - looked_at) / static_cast<double>(asked.size());
    row.appearance = mean_us([&](const SimulatedPlace& place) {
      found += candidates_.by_appearance(place.context).size();
    });
    row.position = mean_us([&](const SimulatedPlace& place) {
      found += candidates_.by_position(place.p_map, kReach_m) ? 1U : 0U;
    });
    if (found == 0) std::puts("no candidate at all");
    row.move = 1e6 * cpu_seconds_of([&] { candidates_.move(positions()); });
    row.recall = recall();
    return row;
  }

 private:
  static constexpr std::size_t kRingKeys = 10;

  const std::vector<float>& ring_key(std::size_t i) const { return places_[i].context.ring_key(); }

  std::vector<Eigen::Vector3d> positions() const {
    std::vector<Eigen::Vector3d> p_map;
    for (std::size_t i = 0; i < size_; ++i) p_map.push_back(places_[i].p_map);
    return p_map;
  }

  /// Beside looking at every one, for a fifth of the keyframes asked for.
  double recall() const {
    std::size_t found = 0;
    std::size_t expected = 0;
    for (std::size_t k = 0; k < kSearches; k += 5) {
      const std::vector<float>& key = ring_key(size_ + k);
      std::vector<double> squared;
      for (std::size_t i = 0; i < ring_keys_.size(); ++i) {
        squared.push_back(squared_distance(key, ring_key(i)));
      }
      std::vector<double> sorted = squared;
      const auto last = sorted.begin() + static_cast<std::ptrdiff_t>(kRingKeys - 1);
      std::nth_element(sorted.begin(), last, sorted.end());
      const double farthest = *last + 1e-9;
      for (const std::size_t near : ring_keys_.nearest(key, kRingKeys)) {
        if (squared[near] <= farthest) ++found;
      }
      expected += kRingKeys;
    }
    return static_cast<double>(found) / static_cast<double>(expected);
  }

  std::span<const SimulatedPlace> places_;
  slam::LoopCandidates candidates_;
  slam::RingKeyIndex ring_keys_;
  std::size_t size_ = 0;
};

}  // namespace

void print_loop_search(std::span<const SimulatedPlace> places, std::span<const std::size_t> sizes) {
  std::printf("microseconds of the processor a keyframe; growth since the first row\n");
  std::printf("%9s %8s %10s %10s %11s %9s %8s %8s %8s %7s %10s\n", "keyframes", "adding",
              "ring keys", "looked at", "appearance", "position", "search", "growth", "log n",
              "recall", "move all");
  Search search(places);
  std::vector<Row> rows;
  for (const std::size_t size : sizes) {
    const Row& row = rows.emplace_back(search.at(size));
    const double log_growth =
        std::log(static_cast<double>(size)) / std::log(static_cast<double>(rows.front().keyframes));
    std::printf("%9zu %8.1f %10.1f %10.0f %11.1f %9.2f %8.1f %7.2fx %7.2fx %7.3f %10.0f\n",
                row.keyframes, row.add, row.ring_keys, row.looked_at, row.appearance, row.position,
                row.search(), row.search() / rows.front().search(), log_growth, row.recall,
                row.move);
  }
}

}  // namespace traverse::testing
