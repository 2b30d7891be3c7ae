#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <mrpt/obs/CObservationRawDAQ.h>
#include <mrpt/obs/CSensoryFrame.h>

#include "traverse/geometry/stamp.hpp"

namespace traverse::mrpt_io {

/// What the point clouds that every MRPT from 2.5 to 3.1 reads, CSimplePointsMap 10, cannot hold of
/// their points: MRPT 3 has no CPointsMapXYZI any more.
struct PointAttributes {
  std::vector<float> time;          ///< seconds after the stamp; empty, or one a point
  std::vector<std::uint16_t> ring;  ///< empty, or one a point
  std::vector<float> intensity;     ///< as stored; empty, or one a point

  bool empty() const { return time.empty() && ring.empty() && intensity.empty(); }
};

/// As an observation that stands beside the cloud in a sensory frame. It has no points of its own,
/// so MRPT's programs make the same maps of the frame with and without it.
mrpt::obs::CObservationRawDAQ::Ptr to_observation(const PointAttributes& attributes,
                                                  geometry::Stamp stamp);

/// Whether the observation is one of those.
bool holds_attributes(const mrpt::obs::CObservation& observation);

/// Those of a frame whose cloud has `points`; empty where it holds none for so many.
PointAttributes attributes_of(const mrpt::obs::CSensoryFrame& frame, std::size_t points);

}  // namespace traverse::mrpt_io
