#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

#include <Eigen/Core>

#include "traverse/config/binder.hpp"
#include "traverse/mapping/map_keyframe.hpp"

namespace traverse::mapping {

struct OccupancyOptions {
  double cell_m = 0.1;
  double max_range_m = 40;    ///< points farther from the sensor do not count
  double min_height_m = 0.3;  ///< above the ground: lower is no obstacle
  double max_height_m = 2;    ///< and higher is driven under
};
void bind(config::Binder& binder, OccupancyOptions& options);

/// Where one can drive and where not, seen from above: MRPT's occupancy grid
/// (mrpt::maps::COccupancyGridMap2D), filled from keyframes in a map whose z is about up.
///
/// The ground's height is the lowest that keyframes saw within a metre or two. Every keyframe is
/// turned into a planar scan of obstacles, points between two heights above the ground: cells are
/// free up to the nearest obstacle of a beam, or without one to its farthest point of the ground.
class OccupancyGrid {
 public:
  /// \throws std::invalid_argument if no keyframe has a point in range, or the grid would have more
  /// than 400 million cells
  OccupancyGrid(std::span<const MapKeyframe> keyframes, const OccupancyOptions& options);
  OccupancyGrid(OccupancyGrid&&) noexcept;
  OccupancyGrid& operator=(OccupancyGrid&&) noexcept;
  ~OccupancyGrid();

  std::size_t columns() const;
  std::size_t rows() const;
  double cell_m() const { return cell_m_; }
  /// Lower left corner of the lower left cell, map frame.
  Eigen::Vector2d origin() const;

  /// Probability that there is an obstacle; 0.5 where nothing is known, as outside of the grid.
  double occupancy(const Eigen::Vector2d& p_map) const;

  /// NAME.png and NAME.yaml as ROS' map servers read them ("trinary": black occupied, white free,
  /// grey unknown). \throws files::OutputError
  void write(const std::filesystem::path& png, const std::filesystem::path& yaml) const;

 private:
  struct Content;
  std::unique_ptr<Content> content_;
  double cell_m_ = 0;
};

}  // namespace traverse::mapping
