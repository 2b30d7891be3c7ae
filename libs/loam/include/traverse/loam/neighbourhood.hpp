#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "traverse/config/binder.hpp"
#include "traverse/loam/residuals.hpp"

namespace traverse::loam {

/// When a handful of neighbouring map points counts as a line or a plane.
struct NeighbourhoodOptions {
  double line_ratio = 3;           ///< line: largest eigenvalue at least this times the second
  double line_flatness = 20;       ///< line: second eigenvalue at most this times the smallest, so
                                   ///< that noisy points of one wall do not make a line in it
  double line_thickness_m = 0.2;   ///< line: no neighbour farther from it than this
  double plane_thickness_m = 0.2;  ///< plane: no neighbour farther from it than this
  double plane_spread = 0.02;      ///< plane: second eigenvalue at least this times the largest, so
                                   ///< that points of one scan line do not make a plane
};
void bind(config::Binder& binder, NeighbourhoodOptions& options);

/// The line through `points` by principal component analysis, if they lie like one.
std::optional<Line> fit_line(std::span<const Eigen::Vector3d> points,
                             const NeighbourhoodOptions& options);

/// The plane through `points` by principal component analysis, if they lie like one. (Published
/// LOAM codes solve A n = -1 instead, which fails for planes near the map's origin.)
std::optional<Plane> fit_plane(std::span<const Eigen::Vector3d> points,
                               const NeighbourhoodOptions& options);

}  // namespace traverse::loam
