#include "recording/file_cursor.hpp"

#include <utility>

#include <fmt/format.h>

#include "traverse/files/binary_file.hpp"
#include "traverse/files/text_encoding.hpp"

namespace traverse::dataset {

using files::InputError;
using files::Place;

FileCursor::FileCursor(const std::filesystem::path& path)
    : FileCursor(path, files::read_bytes(path)) {}

FileCursor::FileCursor(std::filesystem::path path, std::vector<std::byte> beginning)
    : path_(std::move(path)), bytes_(std::move(beginning)) {
  const std::string_view text(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
  position_ = files::byte_order_mark(text, path_);
}

std::optional<std::string_view> FileCursor::next_line() {
  if (position_ == bytes_.size()) return std::nullopt;
  const std::string_view text(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
  const std::size_t end = text.find('\n', position_);
  std::string_view line = text.substr(position_, end - position_);
  position_ = end == std::string_view::npos ? bytes_.size() : end + 1;
  ++line_number_;
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::span<const std::byte> FileCursor::rest() const { return std::span(bytes_).subspan(position_); }

std::span<const std::byte> FileCursor::take(std::size_t count) {
  if (count > rest().size()) {
    throw InputError(path_, Place::whole_file(), fmt::format("{} bytes of binary data", count),
                     fmt::format("{}", rest().size()));
  }
  const std::span<const std::byte> taken = rest().first(count);
  position_ += count;
  return taken;
}

InputError FileCursor::error(std::string expected, std::string found) const {
  return {path_, Place::line(line_number_), std::move(expected), std::move(found)};
}

}  // namespace traverse::dataset
