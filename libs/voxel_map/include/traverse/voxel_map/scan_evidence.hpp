#pragma once

#include <array>
#include <cstddef>

#include "traverse/geometry/pose3.hpp"
#include "traverse/lidar/observability.hpp"
#include "traverse/voxel_map/scan_matches.hpp"
#include "traverse/voxel_map/scan_objective.hpp"

namespace traverse::voxel_map {

/// What the matches of a scan say of its pose, told apart in three ways by what makes them err
/// alike, and how old the surfaces are. Perturbations are twists (rotation, translation) in the
/// axes of the map, about the lidar.
struct ScanEvidence {
  /// Of matches that err alike: those in the same block of the map, whose planes have what they are
  /// off by in common; those in the same direction ahead of the lidar, which are of the same moment
  /// of the sweep; those at the same elevation, which are of the same beams.
  static constexpr std::size_t kWays = 3;
  static constexpr std::size_t kParts = 32;  ///< that each way tells apart
  static constexpr std::size_t kAllParts = kWays * kParts;

  lidar::Matrix6 information = lidar::Matrix6::Zero();  ///< sum of w J' J
  /// The same with each match times the age of its surface, in scans: 1 for the last one's.
  lidar::Matrix6 aged = lidar::Matrix6::Zero();
  /// Of the matches in each part, way by way: the sum of w J' r, what that part alone pulls at, and
  /// its share of the information.
  std::array<lidar::Vector6, kAllParts> pull = all(lidar::Vector6(lidar::Vector6::Zero()));
  std::array<lidar::Matrix6, kAllParts> information_of =
      all(lidar::Matrix6(lidar::Matrix6::Zero()));

  /// As if all weights were `factor` times as large.
  void scale(double factor);
  /// With `root` applied to perturbations in the information on both sides, and `shares`, its
  /// square, to what parts pull at: so much of each direction is kept.
  void keep(const lidar::Matrix6& root, const lidar::Matrix6& shares);

 private:
  template <typename One>
  static std::array<One, kAllParts> all(const One& one) {
    std::array<One, kAllParts> parts;
    parts.fill(one);
    return parts;
  }
};

/// At a pose, with the weights of the robust cost (evaluate()).
ScanEvidence scan_evidence(const ScanMatches& matches, const MotionModel& motion,
                           const geometry::Pose3& T_map_lidar, const ObjectiveOptions& options);

}  // namespace traverse::voxel_map
