#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace traverse::replay {

/// Points chosen to be drawn.
struct ChosenPoints {
  std::vector<Eigen::Vector3f> points;  ///< map frame, metres
  std::vector<float> intensity;         ///< 0 .. 1, one a point
  std::size_t of = 0;                   ///< so many there are
};

/// The map as it grew, frame by frame: one point a voxel, the first that fell into it. What the map
/// was at an earlier frame is a prefix of what it is now, so going back needs no second map.
/// Bounded: with too many points the voxels double and the map is thinned.
class MapHistory {
 public:
  MapHistory(double voxel_m, std::size_t max_points);
  MapHistory(MapHistory&&) noexcept;
  MapHistory& operator=(MapHistory&&) noexcept;
  ~MapHistory();

  std::size_t frames() const { return points_at_frame_.size(); }

  /// Appends the points of the next frame; intensity one a point, or empty.
  void add_frame(std::span<const Eigen::Vector3f> points_map, std::span<const float> intensity);

  /// Points there were after `frames` frames.
  std::size_t size_at(std::size_t frames) const;
  double voxel_m() const { return voxel_m_; }
  const std::vector<Eigen::Vector3f>& points() const { return points_; }
  const std::vector<float>& intensities() const { return intensities_; }

  /// At most about `budget` points of the map after `frames` frames: all of them near `focus`, ever
  /// fewer with distance, evenly within each block of the map. The same for the same arguments.
  ChosenPoints choose(std::size_t frames, const Eigen::Vector3f& focus, std::size_t budget) const;

 private:
  static constexpr int kLevels = 10;
  struct Block {
    Eigen::Vector3f centre;
    /// Indices of points, ascending; level l holds about 2^-(l+1) of the block's points, and the
    /// last level the rest: drawing from the last level down thins evenly.
    std::array<std::vector<std::uint32_t>, kLevels> levels;
  };
  struct Voxels;

  void add(const Eigen::Vector3f& p_map, float intensity);
  void enter_block(std::uint32_t index);
  void coarsen();

  double voxel_m_;
  std::size_t max_points_;
  std::vector<Eigen::Vector3f> points_;
  std::vector<float> intensities_;
  std::vector<std::size_t> points_at_frame_;
  std::vector<Block> blocks_;
  std::unique_ptr<Voxels> voxels_;
};

}  // namespace traverse::replay
