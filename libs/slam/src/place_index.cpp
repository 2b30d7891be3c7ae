#include "traverse/slam/place_index.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <nanoflann.hpp>

#include "traverse/geometry/kd_tree_points.hpp"

namespace traverse::slam {

namespace {

/// Places of any number of dimensions, one after the other.
struct Places {
  std::size_t dimensions;
  std::vector<float> values;

  std::size_t size() const { return values.size() / dimensions; }
  float coordinate(std::size_t i, std::size_t axis) const { return values[i * dimensions + axis]; }
};

using PlaceSet = geometry::KdTreePoints<Places>;

constexpr std::size_t kLeafSize = 10;
constexpr std::size_t kMostPlaces = 100'000'000;

std::invalid_argument other_dimensions() {
  return std::invalid_argument("a place of another number of dimensions than the index");
}

void sort(std::vector<PlaceIndex::Found>& found) {
  using Found = PlaceIndex::Found;
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    return std::tie(a.distance, a.number) < std::tie(b.distance, b.number);
  });
}

}  // namespace

std::array<float, 3> as_place(const Eigen::Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

struct PlaceIndex::Forest {
  using Tree =
      nanoflann::KDTreeSingleIndexDynamicAdaptor<nanoflann::L2_Simple_Adaptor<float, PlaceSet>,
                                                 PlaceSet, -1, std::uint32_t>;

  PlaceSet set;
  Tree tree;

  explicit Forest(std::size_t dimensions)
      : set{{dimensions, {}}},
        tree(static_cast<int>(dimensions), set,
             nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize), kMostPlaces) {}
};

PlaceIndex::PlaceIndex(std::size_t dimensions)
    : dimensions_(dimensions), forest_(std::make_unique<Forest>(dimensions)) {}
PlaceIndex::PlaceIndex(PlaceIndex&&) noexcept = default;
PlaceIndex& PlaceIndex::operator=(PlaceIndex&&) noexcept = default;
PlaceIndex::~PlaceIndex() = default;

// The trees point into their own places, so a copy grows its own.
PlaceIndex::PlaceIndex(const PlaceIndex& other) : PlaceIndex(other.dimensions_) {
  add(other.forest_->set.points.values);
}

PlaceIndex& PlaceIndex::operator=(const PlaceIndex& other) {
  if (this != &other) *this = PlaceIndex(other);
  return *this;
}

void PlaceIndex::add(std::span<const float> places) {
  if (places.size() % dimensions_ != 0) throw other_dimensions();
  if (places.empty()) return;
  const auto first = static_cast<std::uint32_t>(size());
  std::vector<float>& values = forest_->set.points.values;
  values.insert(values.end(), places.begin(), places.end());
  forest_->tree.addPoints(first, static_cast<std::uint32_t>(size() - 1));
}

std::size_t PlaceIndex::size() const { return forest_->set.points.size(); }

std::vector<PlaceIndex::Found> PlaceIndex::nearest(std::span<const float> place,
                                                   std::size_t most) const {
  if (place.size() != dimensions_) throw other_dimensions();
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
  sort(found);
  return found;
}

std::vector<PlaceIndex::Found> PlaceIndex::within(std::span<const float> place,
                                                  double radius) const {
  if (place.size() != dimensions_) throw other_dimensions();
  std::vector<std::pair<std::uint32_t, float>> squared;
  nanoflann::RadiusResultSet<float, std::uint32_t> result(static_cast<float>(radius * radius),
                                                          squared);
  forest_->tree.findNeighbors(result, place.data(), nanoflann::SearchParams());
  std::vector<Found> found;
  found.reserve(squared.size());
  for (const auto& [number, distance] : squared) {
    found.push_back({number, std::sqrt(static_cast<double>(distance))});
  }
  sort(found);
  return found;
}

}  // namespace traverse::slam
