#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "traverse/geometry/pose3.hpp"

namespace traverse::evaluation {

/// The constants of the score. They are part of its definition: two scores compare only if all of
/// them agree.
namespace consistency {
inline constexpr double kLeastRange_m = 5;
inline constexpr double kMostRange_m = 40;
inline constexpr double kVoxel_m = 0.2;   ///< of the sensor frame; one point of each stays
inline constexpr double kRadius_m = 0.5;  ///< neighbours of a query
inline constexpr std::uint32_t kQueryShare = 40;
inline constexpr std::size_t kFewestNeighbours = 12;
inline constexpr std::size_t kFewestScansApart = 10;  ///< neighbours for the distance to a plane
}  // namespace consistency

/// Distances of queries to planes that other scans see.
struct PointToPlane {
  std::size_t queries = 0;  ///< that lie on a planar patch
  double mean_m = 0;
  double median_m = 0;
  double p90_m = 0;  ///< nine in ten are not farther
};

/// How sharp the map is that a trajectory makes of its scans; lower is sharper. Only scores of the
/// same points compare. Read mme and queries first: point_to_plane alone is fooled by a trajectory
/// that has diverged.
struct Consistency {
  double mme = 0;           ///< mean map entropy: mean of 1/2 ln det(2 pi e Sigma)
  double mpv_m = 0;         ///< mean plane deviation: mean of sqrt(smallest eigenvalue of Sigma)
  std::size_t queries = 0;  ///< points with enough neighbours, the mean is over
  std::optional<PointToPlane> point_to_plane;  ///< nothing where no query lies on a plane
  std::size_t scans = 0;
  std::size_t points = 0;  ///< after the reduction
  std::string points_are;  ///< "raw", "corrected, deskewed": what was done to the points
};

/// Scores a trajectory without a reference. A right trajectory puts what several scans saw of a
/// surface in one place, so that the map is sharp.
///
/// Points 5 to 40 m from the sensor, the first of each 0.2 m voxel of the sensor frame, so that the
/// set does not depend on the trajectory. Of these every fortieth, chosen by a hash of its number,
/// is a query; Sigma is the population covariance of the points within 0.5 m of it, itself among
/// them, where there are at least twelve, det Sigma at least 1e-18. The plane for point_to_plane is
/// fitted to neighbours from scans at least ten away, if there are twelve and their eigenvalues say
/// plane: l0 < 0.05 l1 and l1 > 0.1 l2.
///
/// Source: Razlaw et al., "Evaluation of registration methods for sparse 3D laser scans", ECMR
/// 2015, for both means.
///
/// Takes scans as they come and holds only the reduced points, 24 bytes each. The result does not
/// depend on the machine's number of threads.
class ConsistencyScorer {
 public:
  /// `points_are` says what was done to the points, for the report.
  explicit ConsistencyScorer(std::string points_are);

  /// Adds a scan in the sensor's frame, metres; points that are not finite are no points. The
  /// arrays are read here and not kept.
  /// \throws std::invalid_argument if the arrays differ in size or the pose is not finite or not
  /// rigid; EvaluationError if the pose is more than 500 km from the first.
  void add(std::span<const float> x, std::span<const float> y, std::span<const float> z,
           const geometry::Pose3& T_map_lidar);

  /// The score of the scans so far; nothing if no query has enough neighbours. Sorts the points in
  /// place. More scans may be added after it.
  std::optional<Consistency> score();

 private:
  /// A point of the map as the grid cell it lies in and its place in that cell, which a float
  /// holds to 3e-8 m wherever the cell is.
  struct MapPoint {
    std::uint64_t cell;
    std::array<float, 3> in_cell_m;
    std::uint32_t number;  ///< in the order of adding, over all scans
  };
  class Grid;

  std::string points_are_;
  std::vector<MapPoint> points_;
  std::vector<std::uint32_t> first_number_of_scan_;
  /// Of the cells: where the first scan was.
  Eigen::Vector3d p_map_origin_ = Eigen::Vector3d::Zero();
};

}  // namespace traverse::evaluation
