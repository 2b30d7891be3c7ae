#include "traverse/files/atomic_file.hpp"

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include "traverse/files/input_error.hpp"

#include "temporary.hpp"

namespace traverse::files {

namespace {

std::string system_reason(int error, std::string_view otherwise) {
  return error == 0 ? std::string(otherwise) : std::string(std::strerror(error));
}

/// "out/" names the same folder as "out".
std::filesystem::path without_trailing_slash(const std::filesystem::path& path) {
  return path.has_filename() ? path : path.parent_path();
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path)
    : path_(std::move(path)),
      temporary_(std::make_unique<Temporary>(Temporary::Kind::kFile, path_)) {
  errno = 0;
  stream_.open(temporary_->path(), std::ios::binary | std::ios::trunc);
  if (!stream_) throw OutputError(path_, system_reason(errno, "the file cannot be opened"));
}

AtomicFile::~AtomicFile() = default;

const std::filesystem::path& AtomicFile::temporary_path() const { return temporary_->path(); }

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
  std::filesystem::rename(temporary_->path(), path_, failure);
  if (failure) throw OutputError(path_, failure.message());
  temporary_->keep();
}

AtomicFolder::AtomicFolder(std::filesystem::path path) : path_(without_trailing_slash(path)) {
  std::error_code failure;
  if (std::filesystem::exists(path_, failure) && !(std::filesystem::is_directory(path_, failure) &&
                                                   std::filesystem::is_empty(path_, failure))) {
    throw OutputError(path_, "it is there already");
  }
  temporary_ = std::make_unique<Temporary>(Temporary::Kind::kFolder, path_);
}

AtomicFolder::~AtomicFolder() = default;

const std::filesystem::path& AtomicFolder::temporary_path() const { return temporary_->path(); }

void AtomicFolder::commit() {
  std::error_code failure;
  std::filesystem::rename(temporary_->path(), path_, failure);  // also over an empty folder
  if (failure) throw OutputError(path_, failure.message());
  temporary_->keep();
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
