#pragma once

#include <vector>

#include <Eigen/Core>

#include "evidence/gnss_track.hpp"

namespace traverse::plausibility {

/// What the two numbers of a place may mean.
enum class PlaceReading {
  kAsRead,
  kSwapped,  ///< longitude, latitude
  kRadians,
  kDegreesMinutes,  ///< degrees and, as decimals, minutes: 48.3012 is 48 degrees 30.12 minutes
};

/// A straight piece of a receiver's path, long enough for its direction to be told by two fixes.
struct Leg {
  double t0 = 0;
  double t1 = 0;
  Eigen::Vector2d way_m;  ///< east, north

  double length_m() const { return way_m.norm(); }
  double course() const;  ///< counterclockwise from east [rad]
  double middle_s() const { return (t0 + t1) / 2; }
};

struct Legs {
  std::vector<Leg> legs;
  double sigma_m = 0;  ///< of a fix against its neighbours: noise from one to the next, and jolts
};

/// Legs of at least 2 m and 25 sigma in at most 10 s, so that a course is good to 0.1 rad; none if
/// the places are nowhere under that reading. Fixes where no vehicle could have gone to are left
/// out. \param delay_s by which fixes are late, taken off their times
Legs legs_of(const GnssTrack& track, PlaceReading reading, double delay_s);

/// A turn of the course over at least a second.
struct CourseTurn {
  double t0 = 0;
  double t1 = 0;
  double turn = 0;  ///< counterclockwise [rad]
};

/// Those between legs of one path, one after the other. A vehicle that reverses turns its course at
/// once; such are left out.
std::vector<CourseTurn> all_course_turns(const Legs& legs);
/// Those of them that noise does not explain.
std::vector<CourseTurn> course_turns(const Legs& legs);

/// The difference of two angles in (-pi, pi].
double wrapped(double angle);

}  // namespace traverse::plausibility
