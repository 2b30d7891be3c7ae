#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"
#include "traverse/geometry/stamp.hpp"
#include "traverse/sensors/lidar_scan.hpp"
#include "traverse/sensors/rig.hpp"

/// What a recording really holds, found by reading all of it.
namespace traverse::dataset {

/// Of a number that each scan has.
struct Spread {
  std::size_t least = 0;
  std::size_t median = 0;  ///< the upper one of two
  std::size_t most = 0;
};

/// A stretch without a measurement, longer than three median intervals.
struct Gap {
  geometry::Stamp begin;
  double seconds = 0;
};

/// A scan with points that cannot be used, or rings that do not fit the lidar's profile.
struct TroubledScan {
  std::size_t frame = 0;  ///< counted from 0 among the scans of its lidar
  geometry::Stamp stamp;
  sensors::PointFaults points;
  std::size_t points_beyond_rings = 0;  ///< whose ring is not one of the profile's
  bool has_one_ring = false;
};

struct LidarSurvey {
  Spread points;
  /// Largest ring number of a scan plus one; nothing if the rings are not known.
  std::optional<Spread> rings;
  std::string why_no_rings;
  int rings_expected = 0;           ///< of the profile; 0 if it does not say
  bool has_intensity = false;       ///< in the first scan
  bool has_stored_times = false;    ///< in the first scan
  float earliest_point_time_s = 0;  ///< stored times, relative to the scan's stamp
  float latest_point_time_s = 0;
  std::vector<TroubledScan> troubled;
};

/// All measurements of one sensor.
struct StreamSurvey {
  std::string sensor;
  sensors::SensorKind kind = sensors::SensorKind::kLidar;
  std::size_t count = 0;
  geometry::Stamp first;
  geometry::Stamp last;
  double median_interval_s = 0;  ///< 0 with fewer than two measurements
  std::vector<Gap> gaps;
  std::optional<LidarSurvey> lidar;

  double duration_s() const { return geometry::seconds_between(first, last); }
  /// Measurements a second over the duration; 0 with fewer than two.
  double rate_hz() const;
};

struct ReferenceSurvey {
  std::size_t poses = 0;
  double length_m = 0;
  geometry::Stamp first;
  geometry::Stamp last;
  /// Share of the scans (of the first lidar, else of all measurements) within the reference's span.
  double share_covered = 0;
};

struct RecordingSurvey {
  std::vector<StreamSurvey> streams;  ///< in the order of their first measurement
  std::optional<ReferenceSurvey> reference;

  std::size_t measurements() const;
  double duration_s() const;  ///< from the first to the last measurement of any sensor
};

/// Reads `source` to its end; rings are found as each lidar's profile says. `progress` is called
/// with each measurement.
RecordingSurvey survey(Source& source,
                       const std::function<void(const sensors::Measurement&)>& progress);

/// The same as far as `goes_on` allows, which is asked behind each measurement.
RecordingSurvey survey(Source& source,
                       const std::function<void(const sensors::Measurement&)>& progress,
                       const std::function<bool(const sensors::Measurement&)>& goes_on);

}  // namespace traverse::dataset
