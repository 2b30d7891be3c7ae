#pragma once

#include <vector>

#include <Eigen/Core>

#include "traverse/geometry/trajectory.hpp"

#include "plot/plot_area.hpp"

namespace traverse::render {

/// A trajectory as a line to draw: positions in order, with a NaN position at each gap in time and
/// in place of each pose that is not finite.
struct Path {
  std::vector<Eigen::Vector3d> positions;  ///< metres, map frame
  std::vector<double> distances;   ///< travelled until there, metres; gaps are crossed straight
  std::vector<std::size_t> poses;  ///< the pose of each position; at a gap in time, the one before

  bool empty() const { return first_finite() == positions.size(); }
  std::size_t first_finite() const;  ///< index into positions; their number if there is none
  std::size_t last_finite() const;
  double length() const { return distances.empty() ? 0 : distances.back(); }
};

/// A gap is more than five times the median time between poses, and more than half a second.
Path path_of(const geometry::Trajectory& trajectory);

/// The smallest ranges of x, y and z that hold the path; [0, 1] if it is empty.
struct Bounds {
  Range x, y, z;
};
Bounds bounds_of(const Path& path);

/// The path from above in `area`.
std::vector<Point> seen_from_above(const Path& path, const PlotArea& area);

/// A place on a line and where the line goes there.
struct PlaceOnLine {
  Point at;
  Point direction;  ///< unit vector; zero where the line does not move
};

/// The place of `line` at `distance`, which `distances` gives for each of its points. The direction
/// is that of the line over `reach` pixels to each side, so that jitter does not turn it.
PlaceOnLine place_at(const std::vector<Point>& line, const std::vector<double>& distances,
                     double distance, double reach);

/// Marks on a path's line: cross lines at each tenth of its length, arrow heads between them, a
/// disc at the start and an open square at the end. Marks that would lie on one another are left
/// out.
void draw_path_marks(Canvas& canvas, const std::vector<Point>& line, const Path& path,
                     Colour colour);

}  // namespace traverse::render
