#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/files/atomic_file.hpp"

#include "point_clouds/field_values.hpp"

namespace traverse::dataset {

namespace {

constexpr std::size_t kPointsAtOnce = 1 << 14;  // so that a large map is not copied whole

void write(std::ostream& stream, std::string_view text) {
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
}

void write_binary_points(std::ostream& stream, const PointCloud& cloud) {
  std::size_t point_bytes = 0;
  for (const auto& field : cloud.fields()) point_bytes += bytes_of(type_of(field.values));
  std::vector<std::byte> buffer(point_bytes * kPointsAtOnce);
  for (std::size_t begin = 0; begin < cloud.size(); begin += kPointsAtOnce) {
    const std::size_t count = std::min(kPointsAtOnce, cloud.size() - begin);
    std::size_t offset = 0;
    for (const auto& field : cloud.fields()) {
      encode(field.values, begin, count, buffer.data() + offset, point_bytes);
      offset += bytes_of(type_of(field.values));
    }
    write(stream, {reinterpret_cast<const char*>(buffer.data()), count * point_bytes});
  }
}

void write_ascii_points(std::ostream& stream, const PointCloud& cloud) {
  std::string line;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    line.clear();
    for (const auto& field : cloud.fields()) {
      append_text(field.values, i, line);
      line += ' ';
    }
    line.back() = '\n';
    write(stream, line);
  }
}

void write_points(std::ostream& stream, const PointCloud& cloud, PointEncoding encoding) {
  if (encoding == PointEncoding::kAscii) {
    write_ascii_points(stream, cloud);
  } else {
    write_binary_points(stream, cloud);
  }
}

std::string pcd_header(const PointCloud& cloud, PointEncoding encoding) {
  std::string fields;
  std::string sizes;
  std::string types;
  std::string counts;
  for (const auto& field : cloud.fields()) {
    const auto type = static_cast<std::size_t>(type_of(field.values));
    fields += " " + field.name;
    sizes += fmt::format(" {}", bytes_of(type_of(field.values)));
    types += std::string(" ") + std::string("IUIUIUIUFF").at(type);
    counts += " 1";
  }
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS{}\nSIZE{}\nTYPE{}\n"
      "COUNT{}\nWIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA {}\n",
      fields, sizes, types, counts, cloud.size(), cloud.size(),
      encoding == PointEncoding::kAscii ? "ascii" : "binary");
}

std::string_view ply_type(const PointCloud::Field& field) {
  // The old names: every reader knows them.
  constexpr std::array<std::string_view, 10> kNames{"char", "uchar", "short", "ushort", "int",
                                                    "uint", "",      "",      "float",  "double"};
  const std::string_view name = kNames.at(static_cast<std::size_t>(type_of(field.values)));
  if (name.empty()) {
    throw std::invalid_argument(
        fmt::format("PLY has no 64-bit integers, as in the field '{}'", field.name));
  }
  return name;
}

std::string ply_header(const PointCloud& cloud, PointEncoding encoding) {
  std::string header = fmt::format(
      "ply\nformat {} 1.0\nelement vertex {}\n",
      encoding == PointEncoding::kAscii ? "ascii" : "binary_little_endian", cloud.size());
  for (const auto& field : cloud.fields()) {
    header += fmt::format("property {} {}\n", ply_type(field), field.name);
  }
  return header + "end_header\n";
}

}  // namespace

void write_pcd(const std::filesystem::path& file, const PointCloud& cloud, PointEncoding encoding) {
  files::AtomicFile output(file);
  write(output.stream(), pcd_header(cloud, encoding));
  write_points(output.stream(), cloud, encoding);
  output.commit();
}

void write_ply(const std::filesystem::path& file, const PointCloud& cloud, PointEncoding encoding) {
  files::AtomicFile output(file);
  write(output.stream(), ply_header(cloud, encoding));
  write_points(output.stream(), cloud, encoding);
  output.commit();
}

}  // namespace traverse::dataset
