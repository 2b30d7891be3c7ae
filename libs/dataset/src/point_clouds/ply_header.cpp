#include "point_clouds/ply_header.hpp"

#include <map>
#include <string_view>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"

namespace traverse::dataset {

namespace {

constexpr std::size_t kMostProperties = std::size_t{1} << 12;  // of all elements
constexpr std::size_t kMostHeaderWords = 6;                    // one more than a line can have

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

}  // namespace

bool PlyElement::has_list() const {
  for (const PlyProperty& property : properties) {
    if (property.list_count) return true;
  }
  return false;
}

std::size_t PlyElement::scalar_bytes() const {
  std::size_t sum = 0;
  for (const PlyProperty& property : properties) sum += bytes_of(property.type);
  return sum;
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

}  // namespace traverse::dataset
