#pragma once

#include <optional>
#include <string>
#include <vector>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/dataset/source.hpp"
#include "traverse/geometry/stamp.hpp"

namespace traverse::dataset {

/// What the values of a point's time field count from.
enum class TimeZero {
  kScanStamp,   ///< relative times
  kEpoch,       ///< absolute, on the clock of the scans' stamps
  kFirstPoint,  ///< absolute, on another clock: the first point of a scan is at its stamp
};

/// How the times of points are to be read, the same for all scans of a recording.
struct PointTimeConvention {
  std::string field;
  double unit_s = 1;  ///< seconds that a stored 1 stands for
  TimeZero zero = TimeZero::kScanStamp;
};

/// What is known of the times of points before they are looked at.
struct PointTimeHints {
  double scan_interval_s = 0.1;         ///< from one scan to the next, in the median
  std::optional<double> stated_unit_s;  ///< that the user states
  std::string stated_in;                ///< where
};

/// Decides from the magnitude of the values in one scan, best the last: there absolute times are
/// largest. A sweep lasts no longer than half as long again as there is to the next scan, and no
/// longer than 2 s: the unit is the largest of seconds, milli-, micro- and nanoseconds of which
/// that holds. Values within 2 s of zero are relative, larger ones absolute. Nothing if there is no
/// time field or it cannot be understood; says in `facts` what was decided.
std::optional<PointTimeConvention> find_point_time(const PointCloud& cloud, geometry::Stamp stamp,
                                                   const PointTimeHints& hints,
                                                   std::vector<Fact>& facts);

/// Whether the cloud has a time field and it is the same for all points.
bool has_one_time(const PointCloud& cloud);

/// Seconds after `stamp` of each point. \throws files::InputError if the field is missing.
std::vector<float> point_times(const PointCloud& cloud, const PointTimeConvention& convention,
                               geometry::Stamp stamp, const std::filesystem::path& file);

}  // namespace traverse::dataset
