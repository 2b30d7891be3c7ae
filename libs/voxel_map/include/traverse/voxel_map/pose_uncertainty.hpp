#pragma once

#include <array>

#include "traverse/geometry/pose3.hpp"
#include "traverse/lidar/observability.hpp"
#include "traverse/voxel_map/scan_evidence.hpp"

namespace traverse::voxel_map {

/// How far the pose of a scan may be off, from the first one's, by what the matches show
/// (docs/mathematics-fusion.md, "How far a pose may be off").
///
/// A scan is registered on surfaces that earlier scans brought in with the errors that they had
/// themselves. So its error is that of the map where it stands, and one of its own. Its own is told
/// by what parts of the matches that err alike pull at, at the pose that they agree on. Of it the
/// map keeps one part in the age of the surfaces: that is the drift. It adds up part by part, from
/// the first scan on, so that what does not average out over points, surfaces or scans counts in
/// full.
class PoseUncertainty {
 public:
  PoseUncertainty();

  /// A scan that was registered. Twists as those of ScanEvidence.
  /// \param prediction  information on the pose before the matches, in units of the evidence's;
  /// zero for a lidar alone \param enters_map  its points do  \param growth  by how much the
  /// covariance of the prediction grew since the last scan, as twist about the origin of the map
  void add(const ScanEvidence& evidence, const geometry::Pose3& T_map_lidar, bool enters_map,
           const lidar::Matrix6& prediction, const lidar::Matrix6& growth);

  /// A scan whose pose is only predicted.
  void add_prediction(const lidar::Matrix6& growth) { predicted_ += growth; }

  /// Of T_map_lidar as a twist on its right, T_map_lidar Exp(d), d = (rotation [rad], translation
  /// [m]) in the axes of the lidar.
  lidar::Matrix6 covariance(const geometry::Pose3& T_map_lidar) const;
  /// The part of it that the pose has from the map, and the scan's own.
  lidar::Matrix6 covariance_of_map(const geometry::Pose3& T_map_lidar) const;
  const lidar::Matrix6& covariance_of_scan() const { return own_; }

 private:
  using Pulls = std::array<lidar::Vector6, ScanEvidence::kWays * ScanEvidence::kParts>;
  Pulls drift_;                                        // twists about the map's origin
  lidar::Matrix6 predicted_ = lidar::Matrix6::Zero();  // what predictions have added, the same
  lidar::Matrix6 own_ = lidar::Matrix6::Zero();        // on the right of the lidar's pose
  double own_weight_ = 0;
};

/// The twist about the map's origin of one about the lidar, both in the axes of the map.
lidar::Matrix6 about_the_origin(const geometry::Pose3& T_map_lidar);

}  // namespace traverse::voxel_map
