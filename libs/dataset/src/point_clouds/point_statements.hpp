#pragma once

#include <string>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/dataset/source.hpp"

namespace traverse::dataset {

enum class StatedTimeUnit { kNotStated, kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };
enum class StatedTimeZero { kNotStated, kStamp, kEpoch, kStart, kMiddle, kEnd };

/// Which fields of a point hold what, beside the profile of the lidar that they come from.
struct PointFieldStatements {
  std::string ring_field;  ///< empty: the one of a name that is known
  std::string time_field;
  StatedTimeUnit time_unit = StatedTimeUnit::kNotStated;
  StatedTimeZero time_zero = StatedTimeZero::kNotStated;
};
void bind(config::Binder& binder, PointFieldStatements& statements);

class Statements;
struct PointFieldHints;

/// What is stated of the fields of points, with point_time_unit_s. Interval and place are left to
/// the caller.
PointFieldHints stated_point_fields(const Statements& statements);

/// Tells what is stated of fields where the points of a lidar have none with names.
/// \param prefix tells one lidar's facts from another's \param why there are none
void note_idle_point_statements(const Statements& statements, const std::string& prefix,
                                const std::string& why, std::vector<Fact>& facts);

}  // namespace traverse::dataset
