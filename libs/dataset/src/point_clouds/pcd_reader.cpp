#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <lzf.h>
#include <map>
#include <memory>
#include <span>

#include <fmt/format.h>

#include "traverse/files/binary_file.hpp"
#include "traverse/files/numbers.hpp"

#include "point_clouds/ascii_points.hpp"
#include "point_clouds/field_values.hpp"
#include "point_clouds/pcd.hpp"
#include "point_clouds/point_names.hpp"

namespace traverse::dataset {

using files::InputError;
using files::Place;

namespace {

struct PcdField {
  std::string name;
  std::size_t bytes = 4;
  char type = 'F';
  std::size_t count = 1;

  std::size_t size() const { return bytes * count; }
  /// "_" is padding; several values a point (a histogram) do not fit a PointCloud. A type that is
  /// none counts where the field may be needed.
  bool is_used() const;
};

const std::map<std::pair<char, std::size_t>, ScalarType>& pcd_types() {
  static const std::map<std::pair<char, std::size_t>, ScalarType> kTypes{
      {{'I', 1}, ScalarType::kInt8},  {{'U', 1}, ScalarType::kUint8},
      {{'I', 2}, ScalarType::kInt16}, {{'U', 2}, ScalarType::kUint16},
      {{'I', 4}, ScalarType::kInt32}, {{'U', 4}, ScalarType::kUint32},
      {{'I', 8}, ScalarType::kInt64}, {{'U', 8}, ScalarType::kUint64},
      {{'F', 4}, ScalarType::kFloat}, {{'F', 8}, ScalarType::kDouble}};
  return kTypes;
}

bool PcdField::is_used() const {
  return count == 1 && name != "_" && (pcd_types().contains({type, bytes}) || may_be_needed(name));
}

struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t points = 0;
  std::size_t rows = 1;  ///< HEIGHT, where it fits the points
  std::string data;

  std::size_t point_bytes() const {
    std::size_t sum = 0;
    for (const PcdField& field : fields) sum += field.size();
    return sum;
  }
};

std::size_t parse_count(const FileCursor& file, std::string_view word, std::size_t most) {
  const auto count = files::parse_integer(word);
  if (!count || *count < 0 || static_cast<std::uint64_t>(*count) > most) {
    throw file.error(fmt::format("a whole number up to {}", most), files::in_quotes(word));
  }
  return static_cast<std::size_t>(*count);
}

constexpr std::size_t kMostPoints = std::size_t{1} << 40;
constexpr std::size_t kMostFields = std::size_t{1} << 12;
constexpr std::size_t kMostValues = std::size_t{1} << 16;  // of one field in one point

/// WIDTH x HEIGHT. \throws files::InputError if that is more than a file can hold.
std::size_t product_of(const FileCursor& file, std::size_t width, std::size_t height) {
  if (height > 0 && width > kMostPoints / height) {
    throw InputError(file.path(), Place::key("WIDTH"),
                     fmt::format("WIDTH x HEIGHT up to {}", kMostPoints),
                     fmt::format("{} x {}", width, height));
  }
  return width * height;
}

/// One value a field on this line: SIZE, TYPE, COUNT.
void for_each_field(const FileCursor& file, PcdHeader& header,
                    const std::vector<std::string_view>& words,
                    const std::function<void(PcdField&, std::string_view)>& set) {
  if (words.size() != header.fields.size() + 1) {
    throw file.error(fmt::format("{} values for {} fields", words.front(), header.fields.size()),
                     fmt::format("{}", words.size() - 1));
  }
  for (std::size_t i = 0; i < header.fields.size(); ++i) set(header.fields[i], words[i + 1]);
}

PcdHeader read_pcd_header(FileCursor& file) {
  PcdHeader header;
  std::size_t width = 0;
  std::size_t height = 1;
  bool has_points = false;
  while (const auto line = file.next_line()) {
    const std::vector<std::string_view> words = files::split_words(*line, kMostFields + 2);
    if (words.empty() || words.front().front() == '#') continue;
    const std::string_view key = words.front();
    if (words.size() > kMostFields + 1) {
      throw file.error(fmt::format("at most {} fields", kMostFields), "more");
    }
    if (words.size() < 2) throw file.error("a key and its values", files::in_quotes(*line));
    if (key == "FIELDS" || key == "COLUMNS") {  // COLUMNS: before version 0.6
      header.fields.clear();
      for (std::size_t i = 1; i < words.size(); ++i) {
        PcdField field;
        field.name = words[i];
        header.fields.push_back(field);
      }
    } else if (key == "SIZE") {
      for_each_field(file, header, words, [&](PcdField& field, std::string_view word) {
        field.bytes = parse_count(file, word, 8);
      });
    } else if (key == "TYPE") {
      for_each_field(file, header, words,
                     [](PcdField& field, std::string_view word) { field.type = word.front(); });
    } else if (key == "COUNT") {
      for_each_field(file, header, words, [&](PcdField& field, std::string_view word) {
        field.count = parse_count(file, word, kMostValues);
      });
    } else if (key == "WIDTH") {
      width = parse_count(file, words[1], kMostPoints);
    } else if (key == "HEIGHT") {
      height = parse_count(file, words[1], kMostPoints);
    } else if (key == "POINTS") {
      header.points = parse_count(file, words[1], kMostPoints);
      has_points = true;
    } else if (key == "DATA") {
      header.data = words[1];
      if (header.fields.empty()) throw file.error("FIELDS before DATA", "none");
      if (!has_points) header.points = product_of(file, width, height);
      if (height > 0 && width > 0 && header.points / height == width &&
          header.points % height == 0) {
        header.rows = height;
      }
      return header;
    } else if (key != "VERSION" && key != "VIEWPOINT") {
      throw file.error("a key of the PCD header", files::in_quotes(key));
    }
  }
  throw file.error("a line DATA ascii, binary or binary_compressed", "the end of the file");
}

ScalarType scalar_type(const FileCursor& file, const PcdField& field) {
  const auto found = pcd_types().find({field.type, field.bytes});
  if (found == pcd_types().end()) {
    throw InputError(file.path(), Place::key(field.name), "TYPE and SIZE of a number",
                     fmt::format("{} {}", field.type, field.bytes));
  }
  return found->second;
}

/// \throws files::InputError before memory is taken for points that the file cannot hold.
void check_size(const FileCursor& file, std::size_t points, std::size_t point_bytes,
                std::size_t available) {
  if (point_bytes == 0 || points > available / point_bytes) {
    throw InputError(file.path(), Place::whole_file(),
                     fmt::format("{} points of {} bytes", points, point_bytes),
                     fmt::format("{} bytes", available));
  }
}

/// What LZF can make of a byte at most: a reference of three bytes stands for 264.
constexpr std::uint64_t kMostLzfRatio = 88;

/// Bytes of which only those that were written take memory.
struct Decompressed {
  std::unique_ptr<std::byte[]> bytes;
  std::size_t size = 0;
  std::span<const std::byte> view() const { return {bytes.get(), size}; }
};

/// The values of all points, field after field.
Decompressed decompress(FileCursor& file, const PcdHeader& header) {
  std::uint32_t packed_size = 0;
  std::uint32_t full_size = 0;
  std::memcpy(&packed_size, file.take(sizeof packed_size).data(), sizeof packed_size);
  std::memcpy(&full_size, file.take(sizeof full_size).data(), sizeof full_size);
  if (full_size > files::kMostBytesAtOnce) {
    throw InputError(file.path(), Place::whole_file(),
                     fmt::format("at most {} bytes after decompression", files::kMostBytesAtOnce),
                     fmt::format("a header that states {}", full_size));
  }
  check_size(file, header.points, header.point_bytes(), full_size);
  const std::span<const std::byte> packed = file.take(packed_size);
  if (full_size > kMostLzfRatio * packed_size) {
    throw InputError(file.path(), Place::whole_file(),
                     fmt::format("compressed data for {} bytes", full_size),
                     fmt::format("{} bytes, too few", packed_size));
  }
  Decompressed full{std::make_unique_for_overwrite<std::byte[]>(full_size), full_size};
  if (full_size > 0 &&
      lzf_decompress(packed.data(), packed_size, full.bytes.get(), full_size) != full_size) {
    throw InputError(file.path(), Place::whole_file(),
                     fmt::format("{} bytes after decompression", full_size),
                     "damaged compressed data");
  }
  return full;
}

/// Where the values of a field are: `first` of the first point, then every `stride` bytes.
struct FieldLayout {
  std::size_t first;
  std::size_t stride;
};

std::vector<FieldLayout> interleaved_layout(const PcdHeader& header) {
  std::vector<FieldLayout> layout;
  std::size_t offset = 0;
  for (const PcdField& field : header.fields) {
    layout.push_back({offset, header.point_bytes()});
    offset += field.size();
  }
  return layout;
}

std::vector<FieldLayout> field_after_field_layout(const PcdHeader& header) {
  std::vector<FieldLayout> layout;
  std::size_t offset = 0;
  for (const PcdField& field : header.fields) {
    layout.push_back({offset, field.size()});
    offset += field.size() * header.points;
  }
  return layout;
}

PointCloud decode_fields(const FileCursor& file, const PcdHeader& header,
                         std::span<const std::byte> data, const std::vector<FieldLayout>& layout) {
  PointCloud cloud;
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    const PcdField& field = header.fields[i];
    if (!field.is_used()) continue;
    FieldValues values = make_values(scalar_type(file, field), header.points);
    decode(values, data.data() + layout[i].first, layout[i].stride, false);
    cloud.add(field.name, std::move(values));
  }
  if (!cloud.fields().empty()) cloud.set_rows(header.rows);
  return cloud;
}

PointCloud read_ascii(FileCursor& file, const PcdHeader& header) {
  std::size_t words = 0;
  for (const PcdField& field : header.fields) words += field.count;
  constexpr std::size_t kLeastBytesAWord = 2;  // a digit and a blank or the line's end
  check_size(file, header.points, kLeastBytesAWord * words, file.rest().size() + 1);
  std::vector<FieldValues> values;
  values.reserve(header.fields.size());
  std::vector<AsciiColumn> columns;
  for (const PcdField& field : header.fields) {
    values.push_back(field.is_used() ? make_values(scalar_type(file, field), header.points)
                                     : FieldValues());
    columns.push_back(
        {field.count, field.is_used() ? &values.back() : nullptr, !may_be_needed(field.name)});
  }
  read_ascii_points(file, header.points, columns);
  PointCloud cloud;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (columns[i].values != nullptr && !columns[i].is_left_out)
      cloud.add(header.fields[i].name, std::move(values[i]));
  }
  if (!cloud.fields().empty()) cloud.set_rows(header.rows);
  return cloud;
}

}  // namespace

PointCloud read_pcd(FileCursor& file) {
  const PcdHeader header = read_pcd_header(file);
  if (header.data == "ascii") return read_ascii(file, header);
  if (header.data == "binary") {
    check_size(file, header.points, header.point_bytes(), file.rest().size());
    return decode_fields(file, header, file.rest(), interleaved_layout(header));
  }
  if (header.data == "binary_compressed") {
    const Decompressed data = decompress(file, header);
    return decode_fields(file, header, data.view(), field_after_field_layout(header));
  }
  throw file.error("DATA ascii, binary or binary_compressed", files::in_quotes(header.data));
}

}  // namespace traverse::dataset
