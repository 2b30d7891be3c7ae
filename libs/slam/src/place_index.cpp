#include "traverse/slam/place_index.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <tuple>

#include <nanoflann.hpp>

namespace traverse::slam {

namespace {

/// What nanoflann asks of a point set.
struct PlaceSet {
  std::size_t dimensions;
  std::vector<float> values;

  std::size_t kdtree_get_point_count() const { return values.size() / dimensions; }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return values[i * dimensions + axis];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

constexpr std::size_t kLeafSize = 10;
constexpr std::size_t kMostPlaces = 100'000'000;

}  // namespace

struct PlaceIndex::Forest {
  using Tree =
      nanoflann::KDTreeSingleIndexDynamicAdaptor<nanoflann::L2_Simple_Adaptor<float, PlaceSet>,
                                                 PlaceSet, -1, std::uint32_t>;

  PlaceSet places;
  Tree tree;

  explicit Forest(std::size_t dimensions)
      : places{dimensions, {}},
        tree(static_cast<int>(dimensions), places,
             nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize), kMostPlaces) {}
};

PlaceIndex::PlaceIndex(std::size_t dimensions)
    : dimensions_(dimensions), forest_(std::make_unique<Forest>(dimensions)) {}
PlaceIndex::PlaceIndex(PlaceIndex&&) noexcept = default;
PlaceIndex& PlaceIndex::operator=(PlaceIndex&&) noexcept = default;
PlaceIndex::~PlaceIndex() = default;

// The trees point into their own places, so a copy grows its own.
PlaceIndex::PlaceIndex(const PlaceIndex& other) : PlaceIndex(other.dimensions_) {
  const std::vector<float>& values = other.forest_->places.values;
  for (std::size_t i = 0; i < other.size(); ++i) {
    add(std::span(values).subspan(i * dimensions_, dimensions_));
  }
}

PlaceIndex& PlaceIndex::operator=(const PlaceIndex& other) {
  if (this != &other) *this = PlaceIndex(other);
  return *this;
}

void PlaceIndex::add(std::span<const float> place) {
  if (place.size() != dimensions_) {
    throw std::invalid_argument("a place of another number of dimensions than the index");
  }
  const auto number = static_cast<std::uint32_t>(size());
  forest_->places.values.insert(forest_->places.values.end(), place.begin(), place.end());
  forest_->tree.addPoints(number, number);
}

std::size_t PlaceIndex::size() const { return forest_->places.kdtree_get_point_count(); }

std::vector<PlaceIndex::Found> PlaceIndex::nearest(std::span<const float> place,
                                                   std::size_t most) const {
  if (place.size() != dimensions_) {
    throw std::invalid_argument("a place of another number of dimensions than the index");
  }
  most = std::min(most, size());
  if (most == 0) return {};
  std::vector<std::uint32_t> numbers(most);
  std::vector<float> squared(most);
  nanoflann::KNNResultSet<float, std::uint32_t> result(most);
  result.init(numbers.data(), squared.data());
  forest_->tree.findNeighbors(result, place.data(), nanoflann::SearchParams());
  std::vector<Found> found;
  for (std::size_t i = 0; i < result.size(); ++i) {
    found.push_back({numbers[i], std::sqrt(static_cast<double>(squared[i]))});
  }
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    return std::tie(a.distance, a.number) < std::tie(b.distance, b.number);
  });
  return found;
}

}  // namespace traverse::slam
