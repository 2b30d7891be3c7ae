#include "open_for_reading.hpp"

#include <cerrno>
#include <cstring>

#include "traverse/files/input_error.hpp"

namespace traverse::files {

std::ifstream open_for_reading(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) {
    throw InputError(path, Place::whole_file(), "a readable file", "a folder");
  }
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    throw InputError(path, Place::whole_file(), "a readable file", std::strerror(errno));
  }
  return stream;
}

}  // namespace traverse::files
