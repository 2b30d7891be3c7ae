#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>

#include "traverse/files/binary_file.hpp"
#include "traverse/files/input_error.hpp"

namespace traverse::files {

/// Reads a text file line by line and knows where it is, for error messages. A byte order mark is
/// no part of the first line, a carriage return none of any line's end.
class LineReader {
 public:
  /// Whether a line that begins with '#' is passed over or given.
  enum class Comments { kSkip, kGive };

  /// No line that a person or a program means is as long [bytes]; what is made of a line (words,
  /// numbers) takes many times its memory.
  static constexpr std::size_t kLongestLine = std::size_t{1} << 20;

  /// \throws InputError if the file cannot be opened.
  explicit LineReader(std::filesystem::path path);

  /// Advances to the next line that is not blank (nor a '#' comment); false at the end.
  /// \throws InputError for a line longer than kLongestLine; OtherEncoding for text in UTF-16.
  bool next(Comments comments = Comments::kSkip);

  const std::string& line() const { return line_; }
  std::size_t number() const { return number_; }  ///< of the current line, from 1

  /// An error about the current line, to be thrown.
  InputError error(std::string expected, std::string found) const;
  /// The same, with the line itself as what was found.
  InputError error(std::string expected) const;

 private:
  bool take_line();

  std::filesystem::path path_;
  std::ifstream stream_;
  std::string line_;
  std::size_t number_ = 0;
};

/// The whole file without a byte order mark. \throws InputError if it cannot be read, is larger
/// than kMostBytesAtOnce or is text in UTF-16 (OtherEncoding).
std::string read_text(const std::filesystem::path& path);

}  // namespace traverse::files
