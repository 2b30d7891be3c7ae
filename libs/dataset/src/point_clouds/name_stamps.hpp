#pragma once

#include <optional>
#include <string>
#include <vector>

#include "traverse/geometry/stamp.hpp"

namespace traverse::dataset {

/// Stamps that the names of files hold, and how.
struct NameStamps {
  std::vector<geometry::Stamp> stamps;  ///< one a name
  std::string form;                     ///< "seconds and nanoseconds"
};

/// The stamps in the names of files (without extension), if every one ends with one, all in one
/// form: Unix seconds with decimals (1700000000.1), seconds and nanoseconds (1700000000_100000000,
/// also 1700000000.5000000 where the nanoseconds are not filled up with zeros), whole milli-,
/// micro- or nanoseconds told by their count of digits, or the date and the time of day in UTC
/// (frame_20240102T030405.678901). What stands before it ends with no digit. A whole name that is a
/// decimal number is a time of any size; smaller whole numbers are counts.
std::optional<NameStamps> stamps_in_names(const std::vector<std::string>& names);

}  // namespace traverse::dataset
