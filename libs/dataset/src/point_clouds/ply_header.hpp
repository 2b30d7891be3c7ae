#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "point_clouds/field_values.hpp"
#include "recording/file_cursor.hpp"

namespace traverse::dataset {

enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };

struct PlyProperty {
  std::string name;
  ScalarType type = ScalarType::kFloat;
  std::optional<ScalarType> list_count;  ///< set for a list: the type of its length
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;

  bool has_list() const;
  std::size_t scalar_bytes() const;  ///< of a record without lists
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
};

/// Reads up to and with end_header. \throws files::InputError naming the line that is wrong
PlyHeader read_ply_header(FileCursor& file);

}  // namespace traverse::dataset
