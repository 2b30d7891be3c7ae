#include "point_clouds/point_columns.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <utility>

namespace traverse::dataset {

namespace {

template <typename Stored>
Stored stored_number(const std::byte* at, bool swap_bytes) {
  std::array<std::byte, sizeof(Stored)> bytes;
  std::memcpy(bytes.data(), at, sizeof(Stored));
  if (swap_bytes) std::reverse(bytes.begin(), bytes.end());
  Stored value;
  std::memcpy(&value, bytes.data(), sizeof(Stored));
  return value;
}

template <typename Stored, typename To>
std::vector<To> column_as(const PointColumns& points, const PointColumn& column) {
  std::vector<To> values;
  values.reserve(points.points);
  const std::size_t rows = std::max<std::size_t>(points.rows, 1);
  const std::size_t row_size = points.points / rows;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::byte* at = column.first + row * column.row_stride;
    for (std::size_t i = 0; i < row_size; ++i, at += column.stride) {
      values.push_back(static_cast<To>(stored_number<Stored>(at, column.swap_bytes)));
    }
  }
  return values;
}

/// Calls `take` with a number of the column's type, for its type alone.
template <typename Take>
auto with_type(ScalarType type, const Take& take) {
  switch (type) {
    case ScalarType::kInt8:
      return take(std::int8_t{});
    case ScalarType::kUint8:
      return take(std::uint8_t{});
    case ScalarType::kInt16:
      return take(std::int16_t{});
    case ScalarType::kUint16:
      return take(std::uint16_t{});
    case ScalarType::kInt32:
      return take(std::int32_t{});
    case ScalarType::kUint32:
      return take(std::uint32_t{});
    case ScalarType::kInt64:
      return take(std::int64_t{});
    case ScalarType::kUint64:
      return take(std::uint64_t{});
    case ScalarType::kFloat:
      return take(float{});
    case ScalarType::kDouble:
      break;
  }
  return take(double{});
}

}  // namespace

const PointColumn* PointColumns::find(std::string_view name) const {
  const auto found = std::find_if(columns.begin(), columns.end(),
                                  [&](const PointColumn& column) { return column.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

PointColumns columns_of(const PointCloud& cloud) {
  PointColumns table;
  table.points = cloud.size();
  table.rows = cloud.rows();
  const std::size_t row_size = table.points / table.rows;
  for (const PointCloud::Field& field : cloud.fields()) {
    PointColumn column;
    column.name = field.name;
    column.type = type_of(field.values);
    column.stride = bytes_of(column.type);
    column.row_stride = row_size * column.stride;
    column.first = std::visit(
        [](const auto& values) { return reinterpret_cast<const std::byte*>(values.data()); },
        field.values);
    table.columns.push_back(std::move(column));
  }
  return table;
}

std::vector<float> floats_of(const PointColumns& points, const PointColumn& column) {
  return with_type(column.type,
                   [&](auto stored) { return column_as<decltype(stored), float>(points, column); });
}

std::vector<double> doubles_of(const PointColumns& points, const PointColumn& column) {
  return with_type(column.type, [&](auto stored) {
    return column_as<decltype(stored), double>(points, column);
  });
}

FieldValues values_of(const PointColumns& points, const PointColumn& column) {
  return with_type(column.type, [&](auto stored) {
    using Stored = decltype(stored);
    return FieldValues(column_as<Stored, Stored>(points, column));
  });
}

}  // namespace traverse::dataset
