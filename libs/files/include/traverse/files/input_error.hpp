#pragma once

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace traverse::files {

/// Where in a file something stands: nothing (the file itself), a line or a record.
struct Place {
  std::string text;  ///< "", "line 12", "record 340", "frame 17", "key lidar.range"

  static Place whole_file() { return {}; }
  static Place line(std::size_t number);        ///< counted from 1
  static Place record(std::size_t number);      ///< counted from 0, as MRPT's tools count
  static Place key(std::string_view key_path);  ///< a key of a YAML file
};

/// Input that cannot be used. The message names the file, the place in it, what was expected
/// there and what was found: "times.txt, line 12: expected a number of seconds, found 'abc'".
class InputError : public std::runtime_error {
 public:
  InputError(std::filesystem::path file, Place place, std::string expected, std::string found);

  const std::filesystem::path& file() const { return file_; }
  const Place& place() const { return place_; }
  const std::string& expected() const { return expected_; }
  const std::string& found() const { return found_; }

 private:
  std::filesystem::path file_;
  Place place_;
  std::string expected_;
  std::string found_;
};

/// An output that could not be written: folder missing or read-only, disk full.
class OutputError : public std::runtime_error {
 public:
  OutputError(std::filesystem::path file, std::string reason);

  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
};

/// `text` in single quotes for an error message, shortened when long, control characters shown
/// as \xNN so that a binary file cannot disturb the terminal.
std::string in_quotes(std::string_view text);

}  // namespace traverse::files
