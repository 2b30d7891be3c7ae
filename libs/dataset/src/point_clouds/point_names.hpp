#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "point_clouds/point_columns.hpp"

namespace traverse::dataset {

/// A name in lower case without CloudCompare's "scalar_".
std::string plain_name(std::string_view name);

/// The columns that are called one of `names`, which are plain, in the order of `names`.
std::vector<const PointColumn*> columns_called(const PointColumns& points,
                                               std::initializer_list<std::string_view> names);

std::vector<const PointColumn*> ring_columns(const PointColumns& points);
std::vector<const PointColumn*> intensity_columns(const PointColumns& points);

/// A column, or two, that may hold times by name.
struct TimeColumn {
  const PointColumn* column = nullptr;
  const PointColumn* nanoseconds = nullptr;  ///< beside whole seconds; null: there is none
  std::optional<double> unit_s;              ///< that the name tells
};
/// In the order in which they are taken.
std::vector<TimeColumn> time_columns(const PointColumns& points);

/// Whether a column of that name may be one that a scan is made of.
bool may_be_needed(std::string_view name);

/// Whether a name that is not known sounds like one of a time.
bool sounds_like_time(std::string_view name);

}  // namespace traverse::dataset
