#include "traverse/files/atomic_file.hpp"

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"

namespace traverse::files {

namespace {

std::string system_reason(int error, std::string_view otherwise) {
  return error == 0 ? std::string(otherwise) : std::string(std::strerror(error));
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path)
    : path_(std::move(path)),
      temporary_(path_.parent_path() /
                 fmt::format(".{}.{}.partial", path_.filename().string(), ::getpid())) {
  errno = 0;
  stream_.open(temporary_, std::ios::binary | std::ios::trunc);
  if (!stream_) throw OutputError(path_, system_reason(errno, "the file cannot be opened"));
}

AtomicFile::~AtomicFile() {
  if (committed_) return;
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  errno = 0;
  stream_.flush();
  const bool flushed = stream_.good();
  const int error = errno;
  stream_.close();
  if (!flushed || stream_.fail()) {
    throw OutputError(path_, system_reason(error, "not every byte was taken (is the disk full?)"));
  }
  std::error_code failure;
  std::filesystem::rename(temporary_, path_, failure);
  if (failure) throw OutputError(path_, failure.message());
  committed_ = true;
}

void write_text(const std::filesystem::path& path, std::string_view text) {
  AtomicFile file(path);
  file.stream().write(text.data(), static_cast<std::streamsize>(text.size()));
  file.commit();
}

void make_writable_folder(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) throw OutputError(folder, failure.message());
  if (!std::filesystem::is_directory(folder)) throw OutputError(folder, "it is not a folder");
  AtomicFile probe(folder / "probe");  // removed again: it is never committed
}

}  // namespace traverse::files
