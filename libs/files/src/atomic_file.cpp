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

std::filesystem::path temporary_beside(const std::filesystem::path& path) {
  return path.parent_path() / fmt::format(".{}.{}.partial", path.filename().string(), ::getpid());
}

/// "out/" names the same folder as "out".
std::filesystem::path without_trailing_slash(const std::filesystem::path& path) {
  return path.has_filename() ? path : path.parent_path();
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path)
    : path_(std::move(path)), temporary_(temporary_beside(path_)) {
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

AtomicFolder::AtomicFolder(std::filesystem::path path)
    : path_(without_trailing_slash(path)), temporary_(temporary_beside(path_)) {
  std::error_code failure;
  if (std::filesystem::exists(path_, failure) && !(std::filesystem::is_directory(path_, failure) &&
                                                   std::filesystem::is_empty(path_, failure))) {
    throw OutputError(path_, "it is there already");
  }
  std::filesystem::create_directory(temporary_, failure);
  if (failure) throw OutputError(path_, failure.message());
}

AtomicFolder::~AtomicFolder() {
  if (committed_) return;
  std::error_code ignored;
  std::filesystem::remove_all(temporary_, ignored);
}

void AtomicFolder::commit() {
  std::error_code failure;
  std::filesystem::rename(temporary_, path_, failure);  // also over an empty folder
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
