#include <map>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/numbers.hpp"

#include "point_clouds/ascii_points.hpp"
#include "point_clouds/field_values.hpp"
#include "point_clouds/ply.hpp"
#include "point_clouds/point_names.hpp"

namespace traverse::dataset {

using files::InputError;
using files::Place;

namespace {

constexpr std::size_t kMostProperties = std::size_t{1} << 12;  // of all elements
constexpr std::size_t kMostHeaderWords = 6;                    // one more than a line can have

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

  bool has_list() const {
    for (const PlyProperty& property : properties) {
      if (property.list_count) return true;
    }
    return false;
  }
  std::size_t scalar_bytes() const {
    std::size_t sum = 0;
    for (const PlyProperty& property : properties) sum += bytes_of(property.type);
    return sum;
  }
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
};

ScalarType scalar_type(const FileCursor& file, std::string_view name) {
  static const std::map<std::string_view, ScalarType> kTypes{
      {"char", ScalarType::kInt8},     {"int8", ScalarType::kInt8},
      {"uchar", ScalarType::kUint8},   {"uint8", ScalarType::kUint8},
      {"short", ScalarType::kInt16},   {"int16", ScalarType::kInt16},
      {"ushort", ScalarType::kUint16}, {"uint16", ScalarType::kUint16},
      {"int", ScalarType::kInt32},     {"int32", ScalarType::kInt32},
      {"uint", ScalarType::kUint32},   {"uint32", ScalarType::kUint32},
      {"float", ScalarType::kFloat},   {"float32", ScalarType::kFloat},
      {"double", ScalarType::kDouble}, {"float64", ScalarType::kDouble}};
  const auto found = kTypes.find(name);
  if (found == kTypes.end()) throw file.error("a PLY type", files::in_quotes(name));
  return found->second;
}

PlyFormat parse_format(const FileCursor& file, const std::vector<std::string_view>& words) {
  if (words.size() == 3 && words[2] == "1.0") {
    if (words[1] == "ascii") return PlyFormat::kAscii;
    if (words[1] == "binary_little_endian") return PlyFormat::kLittleEndian;
    if (words[1] == "binary_big_endian") return PlyFormat::kBigEndian;
  }
  throw file.error("format ascii, binary_little_endian or binary_big_endian 1.0", "another");
}

PlyElement parse_element(const FileCursor& file, const std::vector<std::string_view>& words) {
  const auto count = words.size() == 3 ? files::parse_integer(words[2]) : std::nullopt;
  if (!count || *count < 0) throw file.error("element NAME COUNT", "another");
  return {std::string(words[1]), static_cast<std::size_t>(*count), {}};
}

PlyProperty parse_property(const FileCursor& file, const std::vector<std::string_view>& words) {
  if (words.size() == 3) {
    return {std::string(words[2]), scalar_type(file, words[1]), std::nullopt};
  }
  if (words.size() == 5 && words[1] == "list") {
    return {std::string(words[4]), scalar_type(file, words[3]), scalar_type(file, words[2])};
  }
  throw file.error("property TYPE NAME or property list TYPE TYPE NAME", "another");
}

PlyHeader read_ply_header(FileCursor& file) {
  PlyHeader header;
  std::size_t lines = 0;  // of elements and properties
  file.next_line();       // "ply"
  while (const auto line = file.next_line()) {
    const std::vector<std::string_view> words = files::split_words(*line, kMostHeaderWords);
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") return header;
    if (++lines > kMostProperties) {
      throw file.error(fmt::format("at most {} elements and properties", kMostProperties), "more");
    }
    if (words[0] == "format") {
      header.format = parse_format(file, words);
    } else if (words[0] == "element") {
      header.elements.push_back(parse_element(file, words));
    } else if (words[0] == "property" && !header.elements.empty()) {
      header.elements.back().properties.push_back(parse_property(file, words));
    } else {
      throw file.error("a line of the PLY header", files::in_quotes(*line));
    }
  }
  throw file.error("end_header", "the end of the file");
}

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
