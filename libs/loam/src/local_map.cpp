#include "traverse/loam/local_map.hpp"

#include <array>
#include <limits>
#include <tsl/robin_map.h>

#include <nanoflann.hpp>

#include "traverse/geometry/kd_tree_points.hpp"
#include "traverse/geometry/voxel.hpp"

namespace traverse::loam {

namespace {

constexpr std::size_t kLeafSize = 20;
constexpr std::size_t kMostMapNeighbours = 16;

using PointSet = geometry::KdTreePoints<std::span<const Eigen::Vector3d>>;
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointSet>,
                                                 PointSet, 3, std::uint32_t>;

}  // namespace

struct LocalMap::Grid {
  tsl::robin_map<std::uint64_t, std::uint32_t, geometry::VoxelHash>
      voxels;  // key -> place in points_
};

struct LocalMap::Index {
  explicit Index(std::span<const Eigen::Vector3d> points)
      : set{points}, tree(3, set, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize)) {}

  PointSet set;
  Tree tree;
};

LocalMap::LocalMap(double voxel_m, double radius_m)
    : voxel_m_(voxel_m), radius_m_(radius_m), grid_(std::make_unique<Grid>()) {}

LocalMap::LocalMap(const LocalMap& other)
    : voxel_m_(other.voxel_m_),
      radius_m_(other.radius_m_),
      last_centre_(other.last_centre_),
      points_(other.points_),
      counts_(other.counts_),
      keys_(other.keys_),
      grid_(std::make_unique<Grid>(*other.grid_)) {}

LocalMap& LocalMap::operator=(const LocalMap& other) {
  if (this != &other) *this = LocalMap(other);
  return *this;
}

LocalMap::LocalMap(LocalMap&&) noexcept = default;
LocalMap& LocalMap::operator=(LocalMap&&) noexcept = default;
LocalMap::~LocalMap() = default;

std::size_t LocalMap::bytes() const {
  using Voxel = decltype(Grid::voxels)::value_type;
  return points_.size() * sizeof(Eigen::Vector3d) + counts_.size() * sizeof(std::uint32_t) +
         keys_.size() * sizeof(std::uint64_t) +
         grid_->voxels.bucket_count() * (sizeof(Voxel) + sizeof(std::uint64_t));
}

void LocalMap::insert(std::span<const Eigen::Vector3d> points_map) {
  index_.reset();
  for (const Eigen::Vector3d& p : points_map) {
    const std::uint64_t key = geometry::voxel_key(p, voxel_m_);
    const auto [entry, is_new] =
        grid_->voxels.try_emplace(key, static_cast<std::uint32_t>(points_.size()));
    if (is_new) {
      points_.push_back(p);
      counts_.push_back(1);
      keys_.push_back(key);
    } else {
      const std::uint32_t i = entry->second;
      ++counts_[i];
      points_[i] += (p - points_[i]) / counts_[i];
    }
  }
}

void LocalMap::follow(const Eigen::Vector3d& centre_map) {
  if ((centre_map - last_centre_).norm() < 0.1 * radius_m_) return;
  last_centre_ = centre_map;
  index_.reset();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if ((points_[i] - centre_map).squaredNorm() > radius_m_ * radius_m_) continue;
    points_[kept] = points_[i];
    counts_[kept] = counts_[i];
    keys_[kept] = keys_[i];
    ++kept;
  }
  points_.resize(kept);
  counts_.resize(kept);
  keys_.resize(kept);
  grid_->voxels.clear();
  for (std::size_t i = 0; i < kept; ++i) {
    grid_->voxels.emplace(keys_[i], static_cast<std::uint32_t>(i));
  }
}

bool LocalMap::has_index() const { return index_ != nullptr; }

void LocalMap::build_index() { index_ = std::make_unique<Index>(points_); }

std::size_t LocalMap::nearest(const Eigen::Vector3d& query_map, double radius_m,
                              std::span<std::uint32_t> indices) const {
  if (!index_ || points_.empty()) return 0;
  std::array<double, kMostMapNeighbours> squared_distances{};
  const std::size_t wanted = std::min(indices.size(), kMostMapNeighbours);
  nanoflann::KNNResultSet<double, std::uint32_t> found(wanted);
  found.init(indices.data(), squared_distances.data());
  squared_distances[wanted - 1] = radius_m * radius_m;  // prunes the search beyond the radius
  index_->tree.findNeighbors(found, query_map.data(), nanoflann::SearchParams());
  return found.size();
}

}  // namespace traverse::loam
