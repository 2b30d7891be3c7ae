#include "traverse/slam/ring_key_index.hpp"

#include <algorithm>
// With it the library prefetches by a number that lies behind the end of a list.
#define NO_MANUAL_VECTORIZATION
#include <hnswlib/hnswlib.h>
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

struct RingKeyIndex::Graph {
  hnswlib::L2Space space;
  hnswlib::HierarchicalNSW<float> keys;

  Graph(std::size_t rings, std::size_t capacity)
      : space(rings), keys(&space, capacity, kLinks, kLookedAtToAdd) {
    keys.setEf(kLookedAtToFind);
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
  for (std::size_t k = 0; k < other.size(); ++k) {
    const auto node = static_cast<hnswlib::tableint>(k);
    graph_->keys.addPoint(other.graph_->keys.getDataByInternalId(node), k);
  }
}

RingKeyIndex& RingKeyIndex::operator=(const RingKeyIndex& other) {
  if (this != &other) *this = RingKeyIndex(other);
  return *this;
}

void RingKeyIndex::add(std::span<const float> key) {
  if (key.size() != rings_) {
    throw std::invalid_argument("a ring key of another number of rings than the index");
  }
  if (size() == graph_->keys.max_elements_) graph_->keys.resizeIndex(2 * size());
  graph_->keys.addPoint(key.data(), size());
}

std::size_t RingKeyIndex::size() const { return graph_->keys.cur_element_count; }

std::size_t RingKeyIndex::looked_at() const {
  return static_cast<std::size_t>(graph_->keys.metric_distance_computations);
}

std::vector<std::size_t> RingKeyIndex::nearest(std::span<const float> key, std::size_t most) const {
  if (key.size() != rings_) {
    throw std::invalid_argument("a ring key of another number of rings than the index");
  }
  most = std::min(most, size());
  if (most == 0) return {};
  auto queue = graph_->keys.searchKnn(key.data(), most);
  std::vector<std::pair<float, std::size_t>> found;
  for (; !queue.empty(); queue.pop()) found.emplace_back(queue.top());
  std::sort(found.begin(), found.end());
  std::vector<std::size_t> numbers;
  numbers.reserve(found.size());
  for (const auto& [distance, number] : found) numbers.push_back(number);
  return numbers;
}

}  // namespace traverse::slam
