#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "traverse/dataset/point_cloud_file.hpp"

namespace traverse::dataset {

/// The types of a field, in the order of FieldValues.
enum class ScalarType {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat,
  kDouble
};

ScalarType type_of(const FieldValues& values);
std::size_t bytes_of(ScalarType type);

/// `count` zeros.
FieldValues make_values(ScalarType type, std::size_t count);

/// Fills all of `values` from memory, `stride` bytes from one to the next, unaligned.
void decode(FieldValues& values, const std::byte* first, std::size_t stride, bool swap_bytes);

/// Puts `count` values from index `begin` into memory, `stride` bytes from one to the next.
void encode(const FieldValues& values, std::size_t begin, std::size_t count, std::byte* first,
            std::size_t stride);

/// Sets value `index` from text; false if the text is not a number of that type.
bool parse_into(FieldValues& values, std::size_t index, std::string_view text);

/// Appends value `index` so that parse_into() gives it back bit for bit.
void append_text(const FieldValues& values, std::size_t index, std::string& text);

}  // namespace traverse::dataset
