#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/parallel/workers.hpp"
#include "traverse/voxel_map/cell_grid.hpp"
#include "traverse/voxel_map/cell_table.hpp"
#include "traverse/voxel_map/local_points.hpp"
#include "traverse/voxel_map/moments.hpp"

namespace traverse::voxel_map {

struct PlaneMapOptions {
  double cell_m = 0.5;        ///< edge of a cell; its parent is three times as wide
  int min_points = 8;         ///< a cell needs to have a plane
  double refit_growth = 1.2;  ///< a plane is fitted again when its points have grown by this factor
  PlaneFitOptions fit;
};
void bind(config::Binder& binder, PlaneMapOptions& options);

/// A plane of a cell as the registration reads it: 32 bytes, apart from the sums it was made from.
struct PlaneCell {
  float nx = 0, ny = 0, nz = 1, d = 0;  ///< n . (p - centre of the cell) + d = 0
  float variance = 0;                   ///< across the plane, square metres
  std::uint32_t is_plane = 0;
  std::uint32_t parent = 0;  ///< index of the coarse cell, for a fine one
  float inserted = 0;        ///< mean number of the inserts that its points came by
};

/// A map of planes: for each cell of a grid, the plane through the points that fell into it. Where
/// a cell has too few for one, the cell three times as wide around it answers. The cells are dealt
/// out to a fixed number of shards that share nothing, so that they can be filled in parallel with
/// the same result.
class PlaneMap {
 public:
  static constexpr std::size_t kShards = 16;

  explicit PlaneMap(const PlaneMapOptions& options);

  /// Adds the points of one scan.
  void insert(const LocalPoints& points, parallel::Workers& workers);

  /// Drops cells farther than `radius_m` from `centre_map`; coarse cells go as a whole.
  void keep_near(const Eigen::Vector3d& centre_map, double radius_m, parallel::Workers& workers);

  /// The plane that answers for the points in a cell, in local coordinates: n . p + d = 0.
  struct Answer {
    float nx, ny, nz, d, variance;
    float age;  ///< how many inserts ago its points came, in the mean; 1 is the last
  };
  /// \returns false if neither the cell nor its parent has a plane.
  bool find(const CellGrid& grid, const RelativeCell& cell, Answer& answer) const;

  /// Starts to fetch where find() will look the cell up: the map is larger than the cache.
  void prefetch(const CellGrid& grid, const RelativeCell& cell) const;
  /// Looks the cell up and starts to fetch its plane; a while after prefetch().
  void prefetch_plane(const CellGrid& grid, const RelativeCell& cell) const;

  CellGrid grid(const Eigen::Vector3d& origin_map) const { return {origin_map, options_.cell_m}; }
  /// For each fine cell for which a plane answers the mean of its points, map frame; for the eye.
  std::vector<Eigen::Vector3d> points() const;

  std::size_t size() const;   ///< fine cells, with a plane or without
  std::size_t bytes() const;  ///< of memory held

 private:
  struct ColdCell {
    Moments moments;
    float fitted_n = 0;
    float inserted = 0;         ///< mean number of the inserts that its points came by
    std::uint32_t touched = 0;  ///< number of the last insert()
  };
  struct CellNumber {
    std::int32_t x, y, z;
  };
  /// Cells of one size in one shard: a table of their indices and, by index, what is known.
  struct Level {
    CellTable table;
    std::vector<ColdCell> cold;
    std::vector<PlaneCell> planes;
    std::vector<CellNumber> numbers;

    std::uint32_t find_or_add(const CellNumber& number);
    void move(std::size_t from, std::size_t to);
    void keep_first(std::size_t cells);
    std::size_t bytes() const;
  };
  struct Shard {
    Level fine, coarse;
    std::vector<std::uint32_t> touched_fine, touched_coarse;
    std::vector<std::uint32_t> cells;  ///< of the runs being inserted
  };
  /// Consecutive points of one row that fell into one cell.
  struct Run {
    CellNumber number;
    Moments moments;
  };

  void collect_runs(const LocalPoints& points, std::size_t begin, std::size_t end,
                    std::array<std::vector<Run>, kShards>& runs) const;
  void insert_runs(Shard& shard, const std::vector<Run>& runs) const;
  std::uint32_t fine_cell(Shard& shard, const CellNumber& number) const;
  void refit(Level& level, std::uint32_t cell, double cell_m) const;

  PlaneMapOptions options_;
  std::array<Shard, kShards> shards_;
  std::uint32_t inserts_ = 0;
  std::vector<std::array<std::vector<Run>, kShards>> runs_;  // by chunk; kept for its memory
};

}  // namespace traverse::voxel_map
