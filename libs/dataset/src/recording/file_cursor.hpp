#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/files/input_error.hpp"

namespace traverse::dataset {

/// A file in memory that begins with lines of text (a header) and may go on in binary.
class FileCursor {
 public:
  /// Begins behind a byte order mark. \throws files::InputError if the file cannot be read or is
  /// text in UTF-16.
  explicit FileCursor(const std::filesystem::path& path);
  /// On these bytes, with which the file begins.
  FileCursor(std::filesystem::path path, std::vector<std::byte> beginning);

  /// The next line without its end, or nothing at the end of the file.
  std::optional<std::string_view> next_line();
  std::size_t line_number() const { return line_number_; }  ///< of the last line, from 1

  /// What follows the last line.
  std::span<const std::byte> rest() const;
  /// The next `count` bytes. \throws files::InputError if there are fewer.
  std::span<const std::byte> take(std::size_t count);

  /// An error about the last line, to be thrown.
  files::InputError error(std::string expected, std::string found) const;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::vector<std::byte> bytes_;
  std::size_t position_ = 0;
  std::size_t line_number_ = 0;
};

}  // namespace traverse::dataset
