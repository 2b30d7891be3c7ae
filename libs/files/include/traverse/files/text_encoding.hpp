#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

#include "traverse/files/input_error.hpp"

namespace traverse::files {

/// A text whose characters are not bytes: UTF-16 or UTF-32, as some programs of Windows write.
class OtherEncoding : public InputError {
 public:
  using InputError::InputError;
};

/// Of the bytes that a text file begins with how many are the byte order mark of UTF-8: 3 or 0. A
/// mark is no part of the text. UTF-16 without a mark is known by its NUL bytes, one in two.
/// \param head the first 64 bytes, fewer of a shorter file, or more
/// \throws OtherEncoding naming the encoding and how to change it
std::size_t byte_order_mark(std::string_view head, const std::filesystem::path& file);

}  // namespace traverse::files
