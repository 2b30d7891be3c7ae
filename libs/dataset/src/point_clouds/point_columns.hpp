#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/dataset/point_cloud_file.hpp"

#include "point_clouds/field_values.hpp"

namespace traverse::dataset {

/// One number of every point, wherever the points lie: in the arrays of a file, in the bytes of a
/// message. It refers to that memory, which must outlive it.
struct PointColumn {
  std::string name;
  ScalarType type = ScalarType::kFloat;
  const std::byte* first = nullptr;  ///< of the first point, at any alignment
  std::size_t stride = 0;            ///< bytes from one point of a row to the next
  std::size_t row_stride = 0;        ///< bytes from one row to the next; of one row any
  bool swap_bytes = false;           ///< the numbers are big-endian
};

/// Points as columns of equal length. An organised cloud has rows of equal length, others one row.
struct PointColumns {
  std::size_t points = 0;
  std::size_t rows = 1;  ///< of which `points` is a multiple
  std::vector<PointColumn> columns;

  /// The first column of exactly that name, or null.
  const PointColumn* find(std::string_view name) const;
};

/// The arrays of `cloud`, which must outlive them.
PointColumns columns_of(const PointCloud& cloud);

/// The numbers of one column, one a point, each converted to the nearest of that type.
std::vector<float> floats_of(const PointColumns& points, const PointColumn& column);
std::vector<double> doubles_of(const PointColumns& points, const PointColumn& column);
/// The same in the type that they are stored in.
FieldValues values_of(const PointColumns& points, const PointColumn& column);

}  // namespace traverse::dataset
