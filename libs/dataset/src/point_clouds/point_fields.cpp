#include "point_clouds/point_fields.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/files/input_error.hpp"

#include "point_clouds/point_names.hpp"
#include "point_clouds/point_time.hpp"

namespace traverse::dataset {

using files::InputError;
using files::Place;
using geometry::Stamp;

namespace {

constexpr std::size_t kMostRowsOfRings = 256;

/// True of most of the scans, so that one that is bad decides nothing.
template <typename Holds>
bool holds_for_most(std::span<const PointSample> samples, const Holds& holds) {
  const auto count = std::count_if(samples.begin(), samples.end(), holds);
  return 2 * static_cast<std::size_t>(count) > samples.size();
}

const PointColumn* column_named(const PointColumns& points, const std::string& name) {
  if (const PointColumn* column = points.find(name)) return column;
  for (const PointColumn& column : points.columns) {  // each scan may write it in its own way
    if (plain_name(column.name) == plain_name(name)) return &column;
  }
  return nullptr;
}

std::string name_in(std::span<const PointSample> samples, const char* coordinate) {
  for (const PointSample& sample : samples) {
    if (const auto found = columns_called(sample.points, {std::string_view(coordinate)});
        !found.empty()) {
      return found.front()->name;
    }
  }
  return coordinate;
}

/// Points that the scan has a return of.
std::vector<bool> returns_of(const PointColumns& points, const std::string& x, const std::string& y,
                             const std::string& z) {
  std::array<std::vector<float>, 3> values;
  const std::array<const std::string*, 3> names{&x, &y, &z};
  for (std::size_t k = 0; k < names.size(); ++k) {
    const PointColumn* column = column_named(points, *names[k]);
    if (column == nullptr) return std::vector<bool>(points.points, true);
    values[k] = floats_of(points, *column);
  }
  std::vector<bool> returns(points.points);
  for (std::size_t i = 0; i < points.points; ++i) {
    const float a = values[0][i];
    const float b = values[1][i];
    const float c = values[2][i];
    returns[i] = std::isfinite(a + b + c) && (a != 0 || b != 0 || c != 0);
  }
  return returns;
}

bool holds_ring_numbers(const PointColumns& points, const std::string& name,
                        const std::vector<bool>& returns) {
  const PointColumn* column = column_named(points, name);
  if (column == nullptr) return false;
  const std::vector<double> values = doubles_of(points, *column);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool is_number =
        values[i] >= 0 && values[i] <= 65535 && values[i] == std::floor(values[i]);
    if (returns[i] && !is_number) return false;
  }
  return true;
}

/// A beam turns at one elevation: those of a row differ little from another, those of the rows
/// much.
bool rows_look_like_rings(const PointSample& sample, const PointFields& fields) {
  const PointColumns& points = sample.points;
  if (points.rows < 2 || points.rows > kMostRowsOfRings) return false;
  const PointColumn* x = column_named(points, fields.x);
  const PointColumn* y = column_named(points, fields.y);
  const PointColumn* z = column_named(points, fields.z);
  if (x == nullptr || y == nullptr || z == nullptr) return false;
  const auto xs = doubles_of(points, *x);
  const auto ys = doubles_of(points, *y);
  const auto zs = doubles_of(points, *z);
  const std::size_t row_size = points.points / points.rows;
  double within = 0;
  double sum = 0;
  double sum_of_squares = 0;
  std::size_t rows = 0;
  std::size_t returns = 0;
  for (std::size_t row = 0; row < points.rows; ++row) {
    double row_sum = 0;
    double row_squares = 0;
    std::size_t count = 0;
    for (std::size_t i = row * row_size; i < (row + 1) * row_size; ++i) {
      const double elevation = std::atan2(zs[i], std::hypot(xs[i], ys[i]));
      if (!std::isfinite(elevation) || (xs[i] == 0 && ys[i] == 0 && zs[i] == 0)) continue;
      row_sum += elevation;
      row_squares += elevation * elevation;
      ++count;
    }
    if (count == 0) continue;
    const double n = static_cast<double>(count);
    within += row_squares - row_sum * row_sum / n;
    sum += row_sum / n;
    sum_of_squares += row_sum * row_sum / (n * n);
    ++rows;
    returns += count;
  }
  if (rows < 2) return false;
  const double n = static_cast<double>(rows);
  const double between = (sum_of_squares - sum * sum / n) / n;
  return within / static_cast<double>(returns) < 0.1 * between;
}

void find_rings(std::span<const PointSample> samples, const std::vector<std::vector<bool>>& returns,
                const PointFieldHints& hints, PointFields& fields, std::vector<Fact>& facts) {
  const auto fits = [&](const std::string& name) {
    return holds_for_most(samples, [&](const PointSample& sample) {
      return holds_ring_numbers(sample.points, name,
                                returns[static_cast<std::size_t>(&sample - samples.data())]);
    });
  };
  if (!hints.ring_field.empty()) {
    const bool is_there =
        std::any_of(samples.begin(), samples.end(), [&](const PointSample& sample) {
          return column_named(sample.points, hints.ring_field) != nullptr;
        });
    if (!is_there) {
      throw InputError(hints.recording, Place::key("lidar.ring_field"), "a field of the points",
                       files::in_quotes(hints.ring_field));
    }
    fields.ring = hints.ring_field;
    facts.push_back({"ring field", fmt::format("field '{}'", fields.ring), "stated"});
    return;
  }
  for (const PointSample& sample : samples) {
    for (const PointColumn* column : ring_columns(sample.points)) {
      if (!fits(column->name)) {
        facts.push_back(
            {"ring field", "not used",
             fmt::format("'{}' does not hold whole numbers from 0 to 65535", column->name)});
        continue;
      }
      fields.ring = column->name;
      if (plain_name(fields.ring) != "ring") {
        facts.push_back({"ring field", fmt::format("field '{}'", fields.ring),
                         "its name, and whole numbers in it"});
      }
      return;
    }
    break;
  }
  if (holds_for_most(samples, [&](const PointSample& sample) {
        return rows_look_like_rings(sample, fields);
      })) {
    fields.rings_are_rows = true;
    facts.push_back({"ring field", "rows of the organised cloud",
                     "no field of ring numbers, and a row has one elevation"});
  }
}

void note_unused(std::span<const PointSample> samples, const PointFields& fields,
                 std::vector<Fact>& facts) {
  std::vector<std::string> unused;
  for (const PointColumn& column : samples.front().points.columns) {
    const std::string plain = plain_name(column.name);
    bool is_used = false;
    for (const std::string* name :
         {&fields.x, &fields.y, &fields.z, &fields.intensity, &fields.ring}) {
      is_used = is_used || (!name->empty() && plain_name(*name) == plain);
    }
    if (fields.time) {
      is_used = is_used || plain_name(fields.time->field) == plain ||
                plain_name(fields.time->nanoseconds) == plain;
    }
    if (!is_used) unused.push_back(column.name);
  }
  if (unused.empty()) return;
  facts.push_back({"point fields not used", fmt::format("{}", fmt::join(unused, ", ")),
                   "neither coordinates nor intensity, ring or time"});
}

std::vector<std::uint16_t> rings_of(const PointColumns& points, const PointFields& fields,
                                    const sensors::LidarScan& scan,
                                    const std::filesystem::path& where) {
  std::vector<std::uint16_t> rings;
  if (fields.rings_are_rows) {
    rings.reserve(points.points);
    const std::size_t row_size = points.points / points.rows;
    for (std::size_t i = 0; i < points.points; ++i) {
      rings.push_back(static_cast<std::uint16_t>(i / row_size));
    }
    return rings;
  }
  const PointColumn* column = column_named(points, fields.ring);
  if (column == nullptr) {
    if (!fields.needs_rings) return rings;
    throw InputError(where, Place::whole_file(),
                     "a field '" + fields.ring + "' as in the other scans", "none");
  }
  rings.reserve(points.points);
  const std::vector<double> values = doubles_of(points, *column);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double value = values[i];
    if (value >= 0 && value <= std::numeric_limits<std::uint16_t>::max()) {
      rings.push_back(static_cast<std::uint16_t>(value));
      continue;
    }
    const bool is_return = std::isfinite(scan.x[i] + scan.y[i] + scan.z[i]) &&
                           (scan.x[i] != 0 || scan.y[i] != 0 || scan.z[i] != 0);
    if (!is_return) {
      rings.push_back(0);
    } else if (fields.needs_rings) {
      throw InputError(where, Place::whole_file(), "ring numbers from 0 to 65535",
                       fmt::format("{}", value));
    } else {
      return {};
    }
  }
  return rings;
}

std::vector<float> coordinate_of(const PointColumns& points, const std::string& name,
                                 const std::filesystem::path& where) {
  const PointColumn* column = column_named(points, name);
  if (column == nullptr) {
    throw InputError(where, Place::whole_file(), "fields x, y and z", "no " + plain_name(name));
  }
  return floats_of(points, *column);
}

}  // namespace

PointFields coordinates_of(const PointColumns& points) {
  const PointSample sample{points, {}};
  PointFields fields;
  fields.x = name_in(std::span(&sample, 1), "x");
  fields.y = name_in(std::span(&sample, 1), "y");
  fields.z = name_in(std::span(&sample, 1), "z");
  return fields;
}

PointFields interpret_points(std::span<const PointSample> samples, const PointFieldHints& hints,
                             std::vector<Fact>& facts) {
  PointFields fields;
  fields.x = name_in(samples, "x");
  fields.y = name_in(samples, "y");
  fields.z = name_in(samples, "z");
  if (samples.empty()) return fields;
  for (const PointSample& sample : samples) {
    const auto intensities = intensity_columns(sample.points);
    if (intensities.empty()) continue;
    fields.intensity = intensities.front()->name;
    break;
  }
  std::vector<std::vector<bool>> returns;
  for (const PointSample& sample : samples) {
    returns.push_back(returns_of(sample.points, fields.x, fields.y, fields.z));
  }
  find_rings(samples, returns, hints, fields, facts);
  fields.time = find_point_time(samples, returns, hints, facts);
  note_unused(samples, fields, facts);
  return fields;
}

bool has_one_time(const PointColumns& points) {
  if (points.points < 2) return false;
  for (const TimeColumn& time : time_columns(points)) {
    for (const PointColumn* column : {time.column, time.nanoseconds}) {
      if (column == nullptr) continue;
      const std::vector<double> values = doubles_of(points, *column);
      const bool is_one = std::all_of(values.begin(), values.end(), [&](double value) {
        return value == values.front() || std::isnan(value);
      });
      if (!is_one) return false;
    }
    return true;
  }
  return false;
}

sensors::LidarScan scan_of_columns(const PointColumns& points, Stamp stamp,
                                   const PointFields& fields, const std::filesystem::path& where) {
  sensors::LidarScan scan;
  scan.stamp = stamp;
  scan.x = coordinate_of(points, fields.x, where);
  scan.y = coordinate_of(points, fields.y, where);
  scan.z = coordinate_of(points, fields.z, where);
  if (!fields.intensity.empty()) {
    if (const PointColumn* column = column_named(points, fields.intensity)) {
      scan.intensity = floats_of(points, *column);
    }
  }
  if (!fields.ring.empty() || fields.rings_are_rows) {
    scan.ring = rings_of(points, fields, scan, where);
  }
  if (fields.time) scan.time = point_times(points, *fields.time, scan, where);
  return scan;
}

}  // namespace traverse::dataset
