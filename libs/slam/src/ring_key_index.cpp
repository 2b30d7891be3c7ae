#include "traverse/slam/ring_key_index.hpp"

#include <algorithm>
// With it the library prefetches by a number that lies behind the end of a list.
#define NO_MANUAL_VECTORIZATION
#include <hnswlib/hnswlib.h>
#include <map>
#include <stdexcept>
#include <utility>

namespace traverse::slam {

namespace {

// With fewer looked at while adding, keys of a steady drive can end up where no link leads.
constexpr std::size_t kLinks = 8;            // of a key, on the upper levels; twice as many below
constexpr std::size_t kLookedAtToAdd = 200;  // nearest ones kept while the way is sought
constexpr std::size_t kLookedAtToFind = 80;
constexpr std::size_t kFirstCapacity = 1024;

}  // namespace

/// Each key is one node, however often it was added: equal nodes would spend all their links on
/// each other, and no link would lead to them or away.
struct RingKeyIndex::Graph {
  hnswlib::L2Space space;
  hnswlib::HierarchicalNSW<float> keys;
  std::map<std::vector<float>, std::size_t> node_of;
  std::vector<std::vector<std::size_t>> numbers_at;  ///< of the keys that are a node, ascending
  std::size_t size = 0;

  Graph(std::size_t rings, std::size_t capacity)
      : space(rings), keys(&space, capacity, kLinks, kLookedAtToAdd) {
    keys.setEf(kLookedAtToFind);
  }

  void add(std::vector<float> key) {
    const std::size_t nodes = numbers_at.size();
    const auto [found, is_new] = node_of.try_emplace(std::move(key), nodes);
    if (is_new) {
      if (nodes == keys.max_elements_) keys.resizeIndex(2 * nodes);
      keys.addPoint(found->first.data(), nodes);
      numbers_at.emplace_back();
    }
    numbers_at[found->second].push_back(size++);
  }
};

RingKeyIndex::RingKeyIndex(std::size_t rings)
    : rings_(rings), graph_(std::make_unique<Graph>(rings, kFirstCapacity)) {}
RingKeyIndex::RingKeyIndex(RingKeyIndex&&) noexcept = default;
RingKeyIndex& RingKeyIndex::operator=(RingKeyIndex&&) noexcept = default;
RingKeyIndex::~RingKeyIndex() = default;

// The library's graph cannot be copied; the same keys in the same order make the same one.
RingKeyIndex::RingKeyIndex(const RingKeyIndex& other)
    : rings_(other.rings_),
      graph_(std::make_unique<Graph>(other.rings_, other.graph_->keys.max_elements_)) {
  const Graph& from = *other.graph_;
  for (std::size_t k = 0; k < from.numbers_at.size(); ++k) {
    const auto node = static_cast<hnswlib::tableint>(k);
    graph_->keys.addPoint(from.keys.getDataByInternalId(node), k);
  }
  graph_->node_of = from.node_of;
  graph_->numbers_at = from.numbers_at;
  graph_->size = from.size;
}

RingKeyIndex& RingKeyIndex::operator=(const RingKeyIndex& other) {
  if (this != &other) *this = RingKeyIndex(other);
  return *this;
}

void RingKeyIndex::add(std::span<const float> key) {
  if (key.size() != rings_) {
    throw std::invalid_argument("a ring key of another number of rings than the index");
  }
  graph_->add({key.begin(), key.end()});
}

std::size_t RingKeyIndex::size() const { return graph_->size; }

std::size_t RingKeyIndex::looked_at() const {
  return static_cast<std::size_t>(graph_->keys.metric_distance_computations);
}

std::vector<std::size_t> RingKeyIndex::nearest(std::span<const float> key, std::size_t most) const {
  if (key.size() != rings_) {
    throw std::invalid_argument("a ring key of another number of rings than the index");
  }
  const std::size_t nodes = std::min(most, graph_->numbers_at.size());
  if (nodes == 0) return {};
  std::vector<std::pair<float, std::size_t>> found;
  for (auto queue = graph_->keys.searchKnn(key.data(), nodes); !queue.empty(); queue.pop()) {
    const auto& [distance, node] = queue.top();
    std::size_t left = most;
    for (const std::size_t number : graph_->numbers_at[node]) {
      if (left-- == 0) break;
      found.emplace_back(distance, number);
    }
  }
  std::sort(found.begin(), found.end());
  std::vector<std::size_t> numbers;
  for (const auto& [distance, number] : found) {
    if (numbers.size() == most) break;
    numbers.push_back(number);
  }
  return numbers;
}

}  // namespace traverse::slam
