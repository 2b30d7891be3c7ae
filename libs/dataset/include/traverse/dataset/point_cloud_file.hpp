#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace traverse::dataset {

/// The values of one field, one a point, in the type that the file declares.
using FieldValues =
    std::variant<std::vector<std::int8_t>, std::vector<std::uint8_t>, std::vector<std::int16_t>,
                 std::vector<std::uint16_t>, std::vector<std::int32_t>, std::vector<std::uint32_t>,
                 std::vector<std::int64_t>, std::vector<std::uint64_t>, std::vector<float>,
                 std::vector<double>>;

std::size_t size_of(const FieldValues& values);
/// The values converted, each to the nearest of its new type.
std::vector<float> to_floats(const FieldValues& values);
std::vector<double> to_doubles(const FieldValues& values);

/// Points as named arrays of equal length: x, y, z and whatever else a file holds.
class PointCloud {
 public:
  struct Field {
    std::string name;
    FieldValues values;
  };

  /// \throws std::invalid_argument if `values` is not as long as the fields already there.
  void add(std::string name, FieldValues values);

  /// Of an organised cloud the number of its rows, which hold equally many points; else 1.
  std::size_t rows() const { return rows_; }
  /// \throws std::invalid_argument if the points are no multiple of `rows`.
  void set_rows(std::size_t rows);

  std::size_t size() const { return fields_.empty() ? 0 : size_of(fields_.front().values); }
  const std::vector<Field>& fields() const { return fields_; }
  /// The first field of that name, or null.
  const FieldValues* find(std::string_view name) const;

 private:
  std::vector<Field> fields_;
  std::size_t rows_ = 1;
};

/// Reads a PCD file (ascii, binary, binary_compressed) or a PLY file (ascii, binary of either byte
/// order), told apart by how they begin. Fields with several values a point are left out, and those
/// of a type that is none or whose text is no number unless they are coordinates, ring or time.
/// Sources: PCL "The PCD file format", version 0.7; Turk, "The PLY polygon file format", 1994.
/// \throws files::InputError naming the line of a header or of ascii data that is wrong, and the
/// bytes that are missing from binary data.
PointCloud read_point_cloud(const std::filesystem::path& file);

enum class PointEncoding { kAscii, kBinary };

/// Writes every field under its name, atomically; readable by PCL, CloudCompare and MeshLab.
/// \throws files::OutputError
void write_pcd(const std::filesystem::path& file, const PointCloud& cloud,
               PointEncoding encoding = PointEncoding::kBinary);

/// As write_pcd(); binary is little-endian.
/// \throws std::invalid_argument for 64-bit integers, which PLY does not have.
void write_ply(const std::filesystem::path& file, const PointCloud& cloud,
               PointEncoding encoding = PointEncoding::kBinary);

}  // namespace traverse::dataset
