#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"
#include "traverse/geometry/stamp.hpp"
#include "traverse/sensors/lidar_scan.hpp"

#include "point_clouds/point_columns.hpp"

namespace traverse::dataset {

/// What the values of a point's time column count from.
enum class TimeZero {
  kScanStamp,    ///< the scan's stamp, be it at the sweep's start, middle or end
  kEpoch,        ///< absolute, on the clock of the scans' stamps
  kSweepStart,   ///< anything: the first point of a scan is at its stamp
  kSweepMiddle,  ///< anything: the stamp is midway between the first point and the last
  kSweepEnd,     ///< anything: the last point of a scan is at its stamp
};

/// How the times of points are to be read, the same for all scans of a recording.
struct PointTimeRule {
  std::string field;
  std::string nanoseconds;  ///< a second column, of nanoseconds beside whole seconds; empty: none
  double unit_s = 1;        ///< seconds that a stored 1 stands for
  TimeZero zero = TimeZero::kScanStamp;
  double longest_s = 0;  ///< no scan lasts longer: its times would be wrong
};

/// Which column holds what, the same for all scans of a recording: found once by
/// interpret_points(), used for each scan by scan_of_columns().
struct PointFields {
  std::string x, y, z;
  std::string intensity;        ///< empty: none
  std::string ring;             ///< empty: none
  bool rings_are_rows = false;  ///< a row of the organised cloud is a ring
  bool needs_rings = true;      ///< a scan whose ring numbers are none cannot be used
  std::optional<PointTimeRule> time;
};

/// What is known of the columns before they are looked at.
struct PointFieldHints {
  double scan_interval_s = 0.1;       ///< from one scan to the next, in the median
  std::string ring_field;             ///< that the user states; empty: not stated
  std::string time_field;             ///< the same
  std::optional<double> time_unit_s;  ///< the same
  std::optional<TimeZero> time_zero;  ///< the same
  std::string time_stated_in;         ///< where field, unit or zero of times are stated
  std::filesystem::path recording;    ///< for errors
};

/// A scan to judge the others by.
struct PointSample {
  PointColumns points;
  geometry::Stamp stamp;
};

/// Decides from a few scans which columns hold coordinates, intensity, ring and time. Names are
/// matched without regard to case and to CloudCompare's "scalar_".
///
/// Coordinates: x, y, z. Intensity: intensity, reflectivity, remission, reflectance, i. Ring: ring,
/// ring_id, laser_id, laserid, channel, line, beam, beam_id, where it holds whole numbers; else the
/// rows of an organised cloud, where they look like rings. Time: time, t, timestamp, time_stamp,
/// timestamps, offset_time, time_offset, timeoffset, point_time, relative_time, GpsTime, each also
/// with a unit behind it (_s, _ms, _us, _ns), a pair of ..._sec and ..._nsec, curvature
/// (milliseconds, as FAST-LIO has it).
///
/// A lidar measures all the time, so a sweep lasts no longer than half as long again as there is to
/// the next scan (stamps jitter) and no longer than 3 s, and no shorter than a tenth of that or of
/// 0.1 s (a sector of it). The unit is that of seconds, milli-, micro- and nanoseconds in which the
/// times of most scans do so, or in which they are the scans' stamps. Times that stay within such a
/// span of zero count from the scan's stamp, negative before it; times that stay within it of the
/// scan's stamp are absolute; times that advance from scan to scan as the stamps do are of another
/// clock, and a scan's first point is taken to be at its stamp. If no unit fits, or two columns do
/// that disagree, there are no times. Times of points without a return count for nothing. Says in
/// `facts` what was decided and why, and which columns are of no use.
/// \throws files::InputError if a column is stated that no scan has, or a unit in which a scan
/// would last longer than that.
PointFields interpret_points(std::span<const PointSample> samples, const PointFieldHints& hints,
                             std::vector<Fact>& facts);

/// The columns of coordinates alone, by name.
PointFields coordinates_of(const PointColumns& points);

/// Whether the points have a time column and in it the same time for all.
bool has_one_time(const PointColumns& points);

/// The points of one scan. Label and unit of its coordinates are left to the caller.
/// \param where it stands, for errors
/// \throws files::InputError if x, y or z or the time is missing, a ring number is not 0 to 65535
/// or the times span more than a sweep can.
sensors::LidarScan scan_of_columns(const PointColumns& points, geometry::Stamp stamp,
                                   const PointFields& fields, const std::filesystem::path& where);

}  // namespace traverse::dataset
