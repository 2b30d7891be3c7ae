#include "traverse/files/text_file.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/text_encoding.hpp"

#include "open_for_reading.hpp"

namespace traverse::files {

LineReader::LineReader(std::filesystem::path path)
    : path_(std::move(path)), stream_(open_for_reading(path_)) {}

bool LineReader::take_line() {
  line_.clear();
  std::array<char, 4096> piece;
  for (;;) {
    stream_.getline(piece.data(), piece.size());
    // Without a line's end among its characters: the piece is full, or the file is over.
    const bool is_whole = stream_.good();
    const auto taken = static_cast<std::size_t>(stream_.gcount()) - (is_whole ? 1 : 0);
    line_.append(piece.data(), taken);
    if (is_whole) break;
    if (stream_.eof()) return taken > 0 || !line_.empty();
    if (taken == 0) return false;  // a read error
    stream_.clear();
    if (line_.size() > kLongestLine) break;
  }
  return true;
}

bool LineReader::next(Comments comments) {
  while (take_line()) {
    ++number_;
    if (number_ == 1) line_.erase(0, byte_order_mark(line_, path_));
    if (line_.size() > kLongestLine) {
      throw error(fmt::format("lines of at most {} bytes", kLongestLine), "a longer one");
    }
    if (!line_.empty() && line_.back() == '\r') line_.pop_back();
    const std::size_t first = line_.find_first_not_of(" \t");
    if (first == std::string::npos) continue;
    if (comments == Comments::kGive || line_[first] != '#') return true;
  }
  return false;
}

InputError LineReader::error(std::string expected, std::string found) const {
  return {path_, Place::line(number_), std::move(expected), std::move(found)};
}

InputError LineReader::error(std::string expected) const {
  return error(std::move(expected), in_quotes(line_));
}

std::string read_text(const std::filesystem::path& path) {
  std::ifstream stream = open_for_reading(path);
  std::string text;
  std::array<char, 1 << 16> piece;
  while (stream) {
    stream.read(piece.data(), piece.size());
    text.append(piece.data(), static_cast<std::size_t>(stream.gcount()));
    if (text.size() > kMostBytesAtOnce) {
      throw InputError(path, Place::whole_file(),
                       fmt::format("a text of at most {} bytes", kMostBytesAtOnce), "a longer one");
    }
  }
  text.erase(0, byte_order_mark(text, path));
  return text;
}

}  // namespace traverse::files
