#include "random_access_file.hpp"

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

#include "traverse/files/input_error.hpp"

namespace traverse::bags {

using files::InputError;
using files::Place;

namespace {

InputError unreadable(const std::filesystem::path& file) {
  return {file, Place::whole_file(), "a readable file",
          std::error_code(errno, std::generic_category()).message()};
}

}  // namespace

RandomAccessFile::RandomAccessFile(const std::filesystem::path& file)
    : path_(file), descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (descriptor_ < 0) throw unreadable(file);
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) {
    const InputError error = unreadable(file);
    ::close(descriptor_);
    throw error;
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

RandomAccessFile::~RandomAccessFile() { ::close(descriptor_); }

void RandomAccessFile::read(std::uint64_t offset, std::uint64_t count,
                            std::vector<std::byte>& bytes) const {
  const std::uint64_t there = offset < size_ ? size_ - offset : 0;
  bytes.resize(static_cast<std::size_t>(std::min(count, there)));
  std::size_t got = 0;
  while (got < bytes.size()) {
    const ssize_t more = ::pread(descriptor_, bytes.data() + got, bytes.size() - got,
                                 static_cast<off_t>(offset + got));
    if (more < 0 && errno == EINTR) continue;
    if (more < 0) throw unreadable(path_);
    if (more == 0) break;  // the file has become shorter
    got += static_cast<std::size_t>(more);
  }
  bytes.resize(got);
}

std::vector<std::byte> RandomAccessFile::read(std::uint64_t offset, std::uint64_t count) const {
  std::vector<std::byte> bytes;
  read(offset, count, bytes);
  return bytes;
}

std::vector<std::byte> first_bytes(const std::filesystem::path& file, std::size_t count) {
  return RandomAccessFile(file).read(0, count);
}

}  // namespace traverse::bags
