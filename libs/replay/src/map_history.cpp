#include "traverse/replay/map_history.hpp"

#include <algorithm>
#include <cmath>
#include <tsl/robin_map.h>
#include <utility>

#include "traverse/geometry/voxel.hpp"
#include "traverse/geometry/voxel_set.hpp"

namespace traverse::replay {

namespace {

constexpr double kBlock = 8;   // edge of a block, metres
constexpr float kNearest = 8;  // within this distance of the focus all points are alike, metres
constexpr double kLeastScale = 1e-6;  // of the share of points that is drawn
constexpr double kMostScale = 1e6;
constexpr int kBisections = 30;

/// The level of a point: number l with probability 2^-(l+1), from a hash of its index.
std::size_t level_of(std::uint32_t index, int levels) {
  std::uint64_t bits = geometry::VoxelHash{}(index + 1);
  int level = 0;
  while ((bits & 1U) == 0 && level + 1 < levels) {
    bits >>= 1U;
    ++level;
  }
  return static_cast<std::size_t>(level);
}

std::size_t below(const std::vector<std::uint32_t>& indices, std::size_t end) {
  return static_cast<std::size_t>(std::lower_bound(indices.begin(), indices.end(), end) -
                                  indices.begin());
}

}  // namespace

struct MapHistory::Voxels {
  explicit Voxels(double voxel_m) : taken(voxel_m) {}

  geometry::VoxelSet taken;
  tsl::robin_map<std::uint64_t, std::uint32_t, geometry::VoxelHash> blocks;  // key -> blocks_
};

MapHistory::MapHistory(double voxel_m, std::size_t max_points)
    : voxel_m_(voxel_m), max_points_(max_points), voxels_(std::make_unique<Voxels>(voxel_m)) {}
MapHistory::MapHistory(MapHistory&&) noexcept = default;
MapHistory& MapHistory::operator=(MapHistory&&) noexcept = default;
MapHistory::~MapHistory() = default;

void MapHistory::add_frame(std::span<const Eigen::Vector3f> points_map,
                           std::span<const float> intensity) {
  for (std::size_t i = 0; i < points_map.size(); ++i) {
    add(points_map[i], intensity.empty() ? 0.0F : intensity[i]);
  }
  points_at_frame_.push_back(points_.size());
  while (points_.size() > max_points_) coarsen();
}

void MapHistory::add(const Eigen::Vector3f& p_map, float intensity) {
  if (!voxels_->taken.insert(p_map.cast<double>())) return;
  points_.push_back(p_map);
  intensities_.push_back(intensity);
  enter_block(static_cast<std::uint32_t>(points_.size() - 1));
}

void MapHistory::enter_block(std::uint32_t index) {
  const Eigen::Vector3d p = points_[index].cast<double>();
  const auto [entry, is_new] = voxels_->blocks.try_emplace(
      geometry::voxel_key(p, kBlock), static_cast<std::uint32_t>(blocks_.size()));
  if (is_new) {
    const Eigen::Vector3d corner = (p / kBlock).array().floor() * kBlock;
    blocks_.push_back({(corner.array() + kBlock / 2).matrix().cast<float>(), {}});
  }
  blocks_[entry->second].levels[level_of(index, kLevels)].push_back(index);
}

void MapHistory::coarsen() {
  voxel_m_ *= 2;
  const auto points = std::exchange(points_, {});
  const auto intensities = std::exchange(intensities_, {});
  *voxels_ = Voxels(voxel_m_);
  blocks_.clear();
  std::size_t i = 0;
  for (std::size_t& end : points_at_frame_) {
    for (; i < end; ++i) add(points[i], intensities[i]);
    end = points_.size();
  }
}

std::size_t MapHistory::size_at(std::size_t frames) const {
  if (frames == 0 || points_at_frame_.empty()) return 0;
  return points_at_frame_[std::min(frames, points_at_frame_.size()) - 1];
}

ChosenPoints MapHistory::choose(std::size_t frames, const Eigen::Vector3f& focus,
                                std::size_t budget) const {
  ChosenPoints chosen;
  chosen.of = size_at(frames);
  struct Part {
    const Block* block;
    std::size_t count;
    float nearness;  // 1 near the focus, falling with the square of the distance
  };
  std::vector<Part> parts;
  for (const Block& block : blocks_) {
    std::size_t count = 0;
    for (const auto& level : block.levels) count += below(level, chosen.of);
    if (count == 0) continue;
    const float distance = std::max(kNearest, (block.centre - focus).norm());
    parts.push_back({&block, count, kNearest * kNearest / (distance * distance)});
  }

  // The share of a block's points is min(1, scale * nearness); the scale that fills the budget.
  const auto total = [&](double scale) {
    double sum = 0;
    for (const Part& part : parts) {
      sum += std::min(1.0, scale * static_cast<double>(part.nearness)) *
             static_cast<double>(part.count);
    }
    return sum;
  };
  double least = kLeastScale;
  double most = kMostScale;
  for (int k = 0; k < kBisections; ++k) {
    const double middle = std::sqrt(least * most);
    (total(middle) > static_cast<double>(budget) ? most : least) = middle;
  }

  double owed = 0;  // fractions of points: carried on, or far blocks would never show one
  for (const Part& part : parts) {
    const double share = std::min(1.0, least * static_cast<double>(part.nearness));
    owed += share * static_cast<double>(part.count);
    std::size_t left = std::min(static_cast<std::size_t>(owed), part.count);
    owed -= static_cast<double>(left);
    for (int l = kLevels - 1; l >= 0 && left > 0; --l) {
      const auto& level = part.block->levels[static_cast<std::size_t>(l)];
      const std::size_t take = std::min(left, below(level, chosen.of));
      for (std::size_t k = 0; k < take; ++k) {
        chosen.points.push_back(points_[level[k]]);
        chosen.intensity.push_back(intensities_[level[k]]);
      }
      left -= take;
    }
  }
  return chosen;
}

}  // namespace traverse::replay
