#pragma once

#include <optional>

#include <Eigen/Core>

namespace traverse::voxel_map {

/// Sums of points relative to an origin that stays near them (the centre of their cell), so that
/// floats hold them: n, first moments [m] and second moments [m^2].
struct Moments {
  float n = 0;
  float x = 0, y = 0, z = 0;
  float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  void add(float px, float py, float pz) {
    n += 1;
    x += px;
    y += py;
    z += pz;
    xx += px * px;
    xy += px * py;
    xz += px * pz;
    yy += py * py;
    yz += py * pz;
    zz += pz * pz;
  }
  void add(const Moments& o) {
    n += o.n;
    x += o.x;
    y += o.y;
    z += o.z;
    xx += o.xx;
    xy += o.xy;
    xz += o.xz;
    yy += o.yy;
    yz += o.yz;
    zz += o.zz;
  }
  /// Adds `o`, whose origin lies at (dx, dy, dz) in this one's coordinates.
  void add_shifted(const Moments& o, float dx, float dy, float dz) {
    n += o.n;
    xx += o.xx + 2 * dx * o.x + o.n * dx * dx;
    xy += o.xy + dx * o.y + dy * o.x + o.n * dx * dy;
    xz += o.xz + dx * o.z + dz * o.x + o.n * dx * dz;
    yy += o.yy + 2 * dy * o.y + o.n * dy * dy;
    yz += o.yz + dy * o.z + dz * o.y + o.n * dy * dz;
    zz += o.zz + 2 * dz * o.z + o.n * dz * dz;
    x += o.x + o.n * dx;
    y += o.y + o.n * dy;
    z += o.z + o.n * dz;
  }
  /// Halves every sum: what came before counts half from now on. Exact in floats.
  void forget_half();

  Eigen::Vector3d mean() const;
  Eigen::Matrix3d covariance() const;  ///< population
};

/// A plane through points: normal . p + offset = 0, p relative to the origin of the moments.
struct FittedPlane {
  Eigen::Vector3f normal;  ///< unit
  float offset = 0;        ///< metres
  float variance = 0;      ///< of the points across it, square metres
};

struct PlaneFitOptions {
  double flatness = 0.1;       ///< smallest eigenvalue at most this times the middle one
  double thickness_m = 0.2;    ///< square root of the smallest eigenvalue at most
  double min_width_m = 0.025;  ///< square root of the middle eigenvalue at least: points of one
                               ///< beam lie on a line, which is no plane
};

/// The plane through the points by principal components, if they lie like one. The smallest
/// eigenvalue is found by Newton's method on the characteristic polynomial, from 0: for a
/// covariance that is convex there and the steps rise to the root from one side.
std::optional<FittedPlane> fit_plane(const Moments& moments, const PlaneFitOptions& options);

/// A line through points, as the two planes that meet in it: its direction is the cross product of
/// the normals. The distance from the line is the norm of the two plane residuals, so a line match
/// is two plane rows (the vector line residual, rank 2).
struct FittedLine {
  Eigen::Vector3f normal_1, normal_2;  ///< unit, perpendicular
  float offset_1 = 0, offset_2 = 0;    ///< metres
  float variance = 0;                  ///< larger one across the line, square metres
};

struct LineFitOptions {
  double slenderness = 0.3;    ///< middle eigenvalue at most this times the largest
  double min_length_m = 0.06;  ///< square root of the largest eigenvalue at least
};

std::optional<FittedLine> fit_line(const Moments& moments, const LineFitOptions& options);

}  // namespace traverse::voxel_map
