#pragma once

#include <cstddef>
#include <vector>

#include "traverse/parallel/workers.hpp"
#include "traverse/voxel_map/voxel_map.hpp"

namespace traverse::voxel_map {

/// What an association needs to know of noise.
struct MatchOptions {
  double noise_m = 0.02;        ///< standard deviation of a plane residual, near
  double noise_per_m = 0.0005;  ///< grows with the range by this
  double line_noise_m = 0.02;   ///< more for a line residual: edges are sampled in steps
};
void bind(config::Binder& binder, MatchOptions& options);

/// Points of a scan, as recorded, and the planes of the map that they should lie in, in local
/// coordinates: n . p + d = 0. Structure of arrays.
struct PlaneRows {
  std::vector<float> x, y, z, time;
  std::vector<float> nx, ny, nz, d;
  std::vector<float> weight;  ///< 1 / variance, 1 / m^2
  std::vector<float> age;     ///< of the plane, in scans: PlaneMap::Answer

  void resize(std::size_t rows);
  std::size_t size() const { return x.size(); }
  std::size_t bytes() const;
};

/// The matches of one scan with the map. A line match is row i of `line_1` and of `line_2`: the
/// same point and the two planes that meet in the line.
struct ScanMatches {
  Eigen::Vector3d origin_map;  ///< of the local coordinates
  PlaneRows planes;
  PlaneRows line_1, line_2;
  std::size_t standing_planes = 0;  ///< not nearly horizontal: their matches tell the speed
  double scale = 1;  ///< robust standard deviation of the plane residuals over their weights

  std::size_t size() const { return planes.size() + line_1.size(); }

  std::size_t bytes() const;  ///< of memory that a copy takes

  /// What the map answered for a point's cell. Most points stay in theirs from round to round.
  template <typename Answer>
  struct Remembered {
    RelativeCell cell{0, 0, 0};
    bool asked = false;
    bool found = false;
    Answer answer{};
  };
  std::vector<Remembered<PlaneMap::Answer>> plane_answers;
  std::vector<Remembered<LineMap::Answer>> line_answers;

  /// Before the first association of a scan.
  void forget();
};

/// Matches each planar point with the plane of the cell it falls into under the pose, each edge
/// point with the line of its cell, when no farther from it than `gate_m`. Between calls for one
/// scan and one map `matches` remembers the cells that it asked for. The order is that of the
/// points for any number of workers.
/// \param planar, edges  the scan's points taken to the map under the pose (to_local)
void associate(const SweepSample& sample, const LocalPoints& planar, const LocalPoints& edges,
               const VoxelMap& map, double gate_m, const MatchOptions& options,
               parallel::Workers& workers, ScanMatches& matches);

}  // namespace traverse::voxel_map
