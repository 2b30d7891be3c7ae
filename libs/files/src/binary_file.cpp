#include "traverse/files/binary_file.hpp"

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"

#include "open_for_reading.hpp"

namespace traverse::files {

std::vector<std::byte> read_bytes(const std::filesystem::path& path) {
  std::ifstream stream = open_for_reading(path);
  stream.seekg(0, std::ios::end);
  const std::streamoff size = stream.tellg();
  if (size < 0) throw InputError(path, Place::whole_file(), "a readable file", "a read error");
  if (static_cast<std::uint64_t>(size) > kMostBytesAtOnce) {
    throw InputError(path, Place::whole_file(),
                     fmt::format("a file of at most {} bytes", kMostBytesAtOnce),
                     fmt::format("{} bytes", size));
  }
  stream.seekg(0);
  std::vector<std::byte> bytes(static_cast<std::size_t>(size));
  stream.read(reinterpret_cast<char*>(bytes.data()), size);
  if (stream.gcount() != size) {
    throw InputError(path, Place::whole_file(), "a readable file", "a read error");
  }
  return bytes;
}

}  // namespace traverse::files
