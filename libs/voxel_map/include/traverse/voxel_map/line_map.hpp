#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/voxel_map/cell_grid.hpp"
#include "traverse/voxel_map/cell_table.hpp"
#include "traverse/voxel_map/local_points.hpp"
#include "traverse/voxel_map/moments.hpp"

namespace traverse::voxel_map {

struct LineMapOptions {
  double cell_m = 0.6;
  int min_points = 5;         ///< a cell needs to have a line
  int min_frames = 3;         ///< in which it was seen: passers-by leave no lines
  double refit_growth = 1.2;  ///< a line is fitted again when its points have grown by this factor
  LineFitOptions fit;
};
void bind(config::Binder& binder, LineMapOptions& options);

/// A map of lines: for each cell of a grid, the line through the edge points that fell into it.
class LineMap {
 public:
  explicit LineMap(const LineMapOptions& options) : options_(options) {}

  /// A cell counts as seen once more by each insert().
  void insert(const LocalPoints& points);
  void keep_near(const Eigen::Vector3d& centre_map, double radius_m);

  /// The line that answers for the points in a cell, as two planes in local coordinates: n . p + d
  /// = 0.
  struct Answer {
    float n1[3], d1;
    float n2[3], d2;
    float variance;
    float age;  ///< how many inserts ago its points came, in the mean; 1 is the last
  };
  /// \returns false if the cell has no line.
  bool find(const CellGrid& grid, const RelativeCell& cell, Answer& answer) const;

  /// Starts to fetch what find() will read first for the cell.
  void prefetch(const CellGrid& grid, const RelativeCell& cell) const;

  CellGrid grid(const Eigen::Vector3d& origin_map) const { return {origin_map, options_.cell_m}; }
  /// For each cell with a line the mean of its points, map frame; for the eye.
  std::vector<Eigen::Vector3d> points() const;

  std::size_t size() const { return cold_.size(); }
  std::size_t bytes() const;

 private:
  struct ColdCell {
    Moments moments;
    float fitted_n = 0;
    float inserted = 0;         ///< mean number of the inserts that its points came by
    std::uint32_t touched = 0;  ///< number of the last insert()
    std::int32_t frames = 0;
    std::int32_t number[3];
  };
  struct LineCell {
    FittedLine line;  ///< relative to the centre of the cell
    bool is_line = false;
    float inserted = 0;  ///< as of the cell, when the line was fitted
  };
  std::uint32_t find_or_add(std::int32_t x, std::int32_t y, std::int32_t z);
  void refit(std::uint32_t cell);

  LineMapOptions options_;
  CellTable table_;
  std::vector<ColdCell> cold_;
  std::vector<LineCell> lines_;
  std::vector<std::uint32_t> touched_;
  std::uint32_t inserts_ = 0;
};

}  // namespace traverse::voxel_map
