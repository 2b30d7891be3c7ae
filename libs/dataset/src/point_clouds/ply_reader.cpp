#include <utility>

#include <fmt/format.h>

#include "point_clouds/ascii_points.hpp"
#include "point_clouds/field_values.hpp"
#include "point_clouds/ply.hpp"
#include "point_clouds/ply_header.hpp"
#include "point_clouds/point_names.hpp"

namespace traverse::dataset {

using files::InputError;
using files::Place;

namespace {

double take_number(FileCursor& file, ScalarType type, bool swap_bytes) {
  FieldValues value = make_values(type, 1);
  decode(value, file.take(bytes_of(type)).data(), 0, swap_bytes);
  return to_doubles(value).front();
}

void skip_list(FileCursor& file, const PlyProperty& property, bool swap_bytes) {
  const double length = take_number(file, *property.list_count, swap_bytes);
  if (!(length >= 0 && length < 4.3e9)) {
    throw InputError(file.path(), Place::key(property.name), "the length of a list",
                     fmt::format("{}", length));
  }
  file.take(static_cast<std::size_t>(length) * bytes_of(property.type));
}

/// Passes over an element that stands before the points.
void skip_element(FileCursor& file, const PlyElement& element, PlyFormat format) {
  if (format != PlyFormat::kAscii && !element.has_list()) {
    const std::size_t record = element.scalar_bytes();
    if (record > 0 && element.count > file.rest().size() / record) {
      throw InputError(file.path(), Place::whole_file(),
                       fmt::format("{} records of '{}'", element.count, element.name),
                       fmt::format("{} bytes", file.rest().size()));
    }
    file.take(element.count * record);
    return;
  }
  for (std::size_t i = 0; i < element.count; ++i) {
    if (format == PlyFormat::kAscii) {
      if (!file.next_line()) throw file.error("a line of " + element.name, "the end");
      continue;
    }
    const bool swap_bytes = format == PlyFormat::kBigEndian;
    for (const PlyProperty& property : element.properties) {
      if (property.list_count) {
        skip_list(file, property, swap_bytes);
      } else {
        file.take(bytes_of(property.type));
      }
    }
  }
}

PointCloud read_points(FileCursor& file, const PlyElement& vertex, PlyFormat format) {
  if (vertex.has_list()) {
    throw InputError(file.path(), Place::whole_file(), "points without lists", "a list");
  }
  const bool ascii = format == PlyFormat::kAscii;
  // A value in text is at least a digit and a blank or the line's end.
  const std::size_t record = ascii ? 2 * vertex.properties.size() : vertex.scalar_bytes();
  const std::size_t available = file.rest().size() + (ascii ? 1 : 0);
  if (record == 0 || vertex.count > available / record) {
    throw InputError(file.path(), Place::whole_file(),
                     fmt::format("{} points of {} bytes", vertex.count, record),
                     fmt::format("{} bytes", available));
  }

  std::vector<AsciiColumn> columns;
  std::vector<FieldValues> values;
  values.reserve(vertex.properties.size());
  for (const PlyProperty& property : vertex.properties) {
    values.push_back(make_values(property.type, vertex.count));
  }
  if (ascii) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      columns.push_back({1, &values[i], !may_be_needed(vertex.properties[i].name)});
    }
    read_ascii_points(file, vertex.count, columns);
  } else {
    std::size_t offset = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      decode(values[i], file.rest().data() + offset, record, format == PlyFormat::kBigEndian);
      offset += bytes_of(vertex.properties[i].type);
    }
  }

  PointCloud cloud;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (ascii && columns[i].is_left_out) continue;
    cloud.add(vertex.properties[i].name, std::move(values[i]));
  }
  return cloud;
}

}  // namespace

PointCloud read_ply(FileCursor& file) {
  const PlyHeader header = read_ply_header(file);
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") return read_points(file, element, header.format);
    skip_element(file, element, header.format);
  }
  throw InputError(file.path(), Place::whole_file(), "an element 'vertex'", "none");
}

}  // namespace traverse::dataset
