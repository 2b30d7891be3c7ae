#pragma once

#include <cstdint>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/voxel_map/sweep_points.hpp"
#include "traverse/voxel_map/sweep_rows.hpp"

namespace traverse::voxel_map {

struct SamplingOptions {
  double max_range_m = 80;        ///< farther points make no planar points
  double break_m = 0.15;          ///< neighbours farther apart than break_m + break_per_m * range
  double break_per_m = 0.02;      ///< are on different surfaces
  double spacing_m = 0.2;         ///< between the points kept along a row
  double flatness_m = 0.04;       ///< planar: the mean of 11 neighbours is nearer to the point than
  double flatness_per_m = 0.001;  ///< flatness_m + flatness_per_m * range
  double thinning_m = 0.5;        ///< one planar point a cube of this edge is registered
  double boundary_m = 0.5;        ///< an edge point's neighbour lies farther away by this
  double edge_max_range_m = 60;   ///< farther boundaries are too coarsely sampled
  double pole_width_m = 0.5;      ///< narrower with background on both sides: a pole
};
void bind(config::Binder& binder, SamplingOptions& options);

/// Where a sweep begins and ends: neighbours across it are measured a whole sweep apart, so that no
/// surface is followed over it.
struct Seam {
  bool by_azimuth = false;   ///< between points on either side of the half line (x, y)
  float x = -1, y = 0;       ///< unit
  float time_jump_s = 1e9F;  ///< for rows with times: a jump of more than this
};

enum RowBreak : std::uint8_t { kNoBreak = 0, kStep = 1, kSeam = 2 };

/// breaks[i] tells whether the surface ends between points i and i + 1 of the row, and why. A
/// pure pass of loops without branches.
void find_breaks(const Row& row, const SamplingOptions& options, const Seam& seam,
                 std::vector<std::uint8_t>& breaks);

/// What the walk along one or more rows found. As recorded: neither corrected nor timed.
struct RowSamples {
  SweepPoints surface;                ///< where a surface goes on for five points on both sides
  std::vector<std::uint8_t> planar;   ///< one a surface point: its place is the mean of the window
  SweepPoints edges;                  ///< ends of surfaces before a background, and poles
  std::vector<std::uint32_t> chosen;  ///< surface points of the last row; kept for its memory

  void reserve(std::size_t points);
};

/// Points of surfaces: every spacing_m of arc, where the five neighbours on each side are of the
/// same surface. A point is planar, and moved to the mean of the eleven, when it lies near it.
/// \param nearest points with a smaller range [m] are the vehicle itself
void sample_surfaces(const Row& row, const std::vector<std::uint8_t>& breaks,
                     const SamplingOptions& options, float nearest, RowSamples& samples);

/// Foreground boundaries: the end of a surface (of at least three points) whose neighbour beyond
/// lies more than boundary_m farther from the sensor. What stands nearer than its background on
/// both sides and is narrower than pole_width_m gives one point: the axis of a round pole. (The
/// mean of its returns would go round the axis as the lidar passes, and so follow it a little.)
/// Unlike corners by curvature these are seen from far, and they fix the motion along a street.
/// \param pole_depth from the axis to the mean of the returns, in radii (LidarProfile)
void sample_edges(const Row& row, const std::vector<std::uint8_t>& breaks,
                  const SamplingOptions& options, float nearest, float pole_depth,
                  RowSamples& samples);

}  // namespace traverse::voxel_map
