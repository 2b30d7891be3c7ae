#include "traverse/dataset/point_cloud_file.hpp"

#include <cstring>

#include "traverse/files/input_error.hpp"

#include "point_clouds/pcd.hpp"
#include "point_clouds/ply.hpp"

namespace traverse::dataset {

namespace {

/// A PCD file begins with a comment or with its first key.
bool begins_like_pcd(std::string_view start) {
  return start.starts_with("#") || start.starts_with("VERSION") || start.starts_with("FIELDS") ||
         start.starts_with("COLUMNS");
}

}  // namespace

PointCloud read_point_cloud(const std::filesystem::path& file) {
  FileCursor cursor(file);
  const std::span<const std::byte> bytes = cursor.rest();
  const std::string_view start(reinterpret_cast<const char*>(bytes.data()),
                               std::min<std::size_t>(bytes.size(), 16));
  if (start.starts_with("ply\n") || start.starts_with("ply\r")) return read_ply(cursor);
  if (begins_like_pcd(start)) return read_pcd(cursor);
  throw files::InputError(file, files::Place::line(1), "the beginning of a PCD or PLY file",
                          start.empty() ? "an empty file" : files::in_quotes(start));
}

}  // namespace traverse::dataset
