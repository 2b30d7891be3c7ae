#include "traverse/files/scratch_file.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <unistd.h>

#include "traverse/files/input_error.hpp"

namespace traverse::files {

namespace {

/// Goes on until all bytes are through: one call may take fewer. \returns whether all were.
template <typename Byte, typename Transfer>
bool transfer_all(std::span<Byte> bytes, std::uint64_t offset, const Transfer& transfer) {
  while (!bytes.empty()) {
    const ssize_t count = transfer(bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
  return true;
}

std::string reason() { return errno == 0 ? "it is too short" : std::strerror(errno); }

}  // namespace

ScratchFile::ScratchFile(const std::filesystem::path& folder) : folder_(folder) {
  descriptor_ = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor_ >= 0) return;
  // A file system without nameless files: for a moment there is a name.
  std::string name = (folder / ".scratch.XXXXXX").string();
  descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0) throw OutputError(folder_, reason());
  ::unlink(name.c_str());
}

ScratchFile::~ScratchFile() { ::close(descriptor_); }

std::uint64_t ScratchFile::append(std::span<const std::byte> bytes) {
  errno = 0;
  const std::uint64_t begin = size_;
  const auto write = [this](const void* data, std::size_t count, off_t offset) {
    return ::pwrite(descriptor_, data, count, offset);
  };
  if (!transfer_all(bytes, begin, write)) throw OutputError(folder_, reason());
  size_ += bytes.size();
  return begin;
}

void ScratchFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  errno = 0;
  const auto read = [this](void* data, std::size_t count, off_t from) {
    return ::pread(descriptor_, data, count, from);
  };
  if (!transfer_all(bytes, offset, read)) throw OutputError(folder_, reason());
}

}  // namespace traverse::files
