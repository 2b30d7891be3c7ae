#include "traverse/files/input_error.hpp"

#include <utility>

#include <fmt/format.h>

namespace traverse::files {

namespace {

std::string message(const std::filesystem::path& file, const Place& place,
                    const std::string& expected, const std::string& found) {
  const std::string where = place.text.empty() ? file.string() : file.string() + ", " + place.text;
  return fmt::format("{}: expected {}, found {}", where, expected, found);
}

}  // namespace

Place Place::line(std::size_t number) { return {fmt::format("line {}", number)}; }
Place Place::record(std::size_t number) { return {fmt::format("record {}", number)}; }
Place Place::key(std::string_view key_path) { return {fmt::format("key {}", key_path)}; }

InputError::InputError(std::filesystem::path file, Place place, std::string expected,
                       std::string found)
    : std::runtime_error(message(file, place, expected, found)),
      file_(std::move(file)),
      place_(std::move(place)),
      expected_(std::move(expected)),
      found_(std::move(found)) {}

OutputError::OutputError(std::filesystem::path file, std::string reason)
    : std::runtime_error(fmt::format("{}: cannot be written: {}", file.string(), reason)),
      file_(std::move(file)) {}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string shown = "'";
  for (const char c : text.substr(0, kLongest)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) {
      shown += fmt::format("\\x{:02x}", byte);
    } else {
      shown += c;
    }
  }
  return shown + (text.size() > kLongest ? "...'" : "'");
}

}  // namespace traverse::files
