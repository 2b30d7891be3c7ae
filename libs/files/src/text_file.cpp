#include "traverse/files/text_file.hpp"

#include <sstream>
#include <utility>

#include "open_for_reading.hpp"

namespace traverse::files {

LineReader::LineReader(std::filesystem::path path)
    : path_(std::move(path)), stream_(open_for_reading(path_)) {}

bool LineReader::next() {
  while (std::getline(stream_, line_)) {
    ++number_;
    if (!line_.empty() && line_.back() == '\r') line_.pop_back();
    const std::size_t first = line_.find_first_not_of(" \t");
    if (first != std::string::npos && line_[first] != '#') return true;
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
  std::ostringstream text;
  text << stream.rdbuf();
  return std::move(text).str();
}

}  // namespace traverse::files
