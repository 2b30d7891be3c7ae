#pragma once

#include <string>

#include "comparison/legs.hpp"
#include "evidence/evidence.hpp"

namespace traverse::plausibility {

/// How the numbers of a receiver's places are to be read so that they agree with the other streams.
struct PlaceJudgement {
  PlaceReading reading = PlaceReading::kAsRead;
  std::string figure;      ///< what tells it; empty for kAsRead
  bool is_certain = true;  ///< false: there is no other stream to tell it by
};

/// \param delay_s by which fixes are late
PlaceJudgement judge_places(const Evidence& evidence, const GnssTrack& track, double delay_s);

/// What share of legs has a direction that goes with the heading of the fixes.
struct HeadingAgreement {
  double share = 0;       ///< of the legs within 15 deg of the offset
  double offset_deg = 0;  ///< of the heading to the course as they are read, clockwise
  double course_deg = 0;  ///< by how much the courses themselves spread: half of them are within
  std::size_t legs = 0;   ///< that have a heading
};

/// \param legs at the times of the fixes
/// \param sense 1 of a heading that grows clockwise, -1 counterclockwise
/// \param unit_deg of the heading: 1, or 57.3 for radians
HeadingAgreement heading_agreement(const GnssTrack& track, const Legs& legs, double sense,
                                   double unit_deg);

}  // namespace traverse::plausibility
